// SPDX-License-Identifier: MIT
// Runs the built program as a user would, and folders that tests may fill.
#pragma once

#include "renderer/core/error.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace penumbra::test {

struct Result {
    int exitCode = -1; // -1: it was killed by a signal, after two minutes at the latest
    std::string output, errors;
};

// `environment` holds "NAME=VALUE" to set or "NAME" to take away.
Result runProgram(const std::vector<std::string>& arguments, const std::vector<std::string>& environment = {});

std::string readAll(const std::filesystem::path& file);
void writeAll(const std::filesystem::path& file, const std::string& bytes);

inline bool contains(std::string_view text, std::string_view piece) {
    return text.find(piece) != std::string_view::npos;
}

// The message of the InputError that `action` throws; empty if it throws none.
template <class Action> std::string refusal(Action&& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

// An empty folder that goes away with its contents.
class TemporaryFolder {
public:
    TemporaryFolder();
    ~TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

} // namespace penumbra::test
