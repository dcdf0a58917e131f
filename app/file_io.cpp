// SPDX-License-Identifier: MIT
#include "app/file_io.h"

#include "renderer/core/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <optional>
#include <system_error>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, std::string_view what, int error) {
    throw InputError(fmt::format("{}: {}: {}", file.string(), what, std::generic_category().message(error)));
}

class FileDescriptor {
public:
    explicit FileDescriptor(int number) : number_(number) {}
    ~FileDescriptor() { close(); }
    FileDescriptor(const FileDescriptor&) = delete;
    FileDescriptor& operator=(const FileDescriptor&) = delete;
    int get() const { return number_; }
    // Some file systems report a full disk only here.
    bool close() {
        const int number = number_;
        number_ = -1;
        return number < 0 || ::close(number) == 0;
    }

private:
    int number_;
};

// A new file beside `file`, under a name that nobody has; it is removed again unless it becomes `file`.
class TemporaryFile {
public:
    explicit TemporaryFile(const fs::path& file) : file_(file), name_(file.parent_path() / ".penumbra-XXXXXX") {
        if (std::error_code ignored; fs::exists(file, ignored) && !fs::is_regular_file(file, ignored))
            throw InputError(fmt::format("{}: cannot be written: it is not a regular file", file.string()));
        descriptor_.emplace(::mkstemp(name_.data()));
        if (descriptor_->get() < 0) refuse(file, "cannot be written", errno);
        const mode_t mask = ::umask(0);
        ::umask(mask);
        ::fchmod(descriptor_->get(), 0666 & ~mask); // mkstemp's files are private
        exists_ = true;
    }
    ~TemporaryFile() {
        if (exists_) ::unlink(name_.c_str());
    }
    void write(std::string_view bytes) const {
        while (!bytes.empty()) {
            const ssize_t written = ::write(descriptor_->get(), bytes.data(), bytes.size());
            if (written < 0 && errno == EINTR) continue;
            if (written < 0) refuse(file_, "cannot be written", errno);
            bytes.remove_prefix(static_cast<size_t>(written));
        }
    }
    void becomeFile() {
        if (!descriptor_->close()) refuse(file_, "cannot be written", errno);
        if (::rename(name_.c_str(), file_.c_str()) != 0) refuse(file_, "cannot be written", errno);
        exists_ = false;
    }

private:
    fs::path file_;
    std::string name_;
    std::optional<FileDescriptor> descriptor_;
    bool exists_ = false;
};

} // namespace

std::string readFile(const fs::path& file, size_t limit) {
    const FileDescriptor descriptor(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (descriptor.get() < 0) refuse(file, "cannot be read", errno);
    struct stat status = {};
    if (::fstat(descriptor.get(), &status) != 0) refuse(file, "cannot be read", errno);
    if (S_ISDIR(status.st_mode)) refuse(file, "cannot be read", EISDIR);
    if (!S_ISREG(status.st_mode)) throw InputError(fmt::format("{}: is not a regular file", file.string()));

    // A file may grow, and some say 0: the size told is only where to begin.
    std::string bytes(std::min(limit, static_cast<size_t>(status.st_size)) + 1, '\0');
    size_t size = 0;
    for (;;) {
        if (size == bytes.size()) {
            if (size > limit) break;
            bytes.resize(std::min(limit + 1, 2 * size));
        }
        const ssize_t got = ::read(descriptor.get(), bytes.data() + size, bytes.size() - size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) refuse(file, "cannot be read", errno);
        if (got == 0) break;
        size += static_cast<size_t>(got);
    }
    if (size > limit) throw InputError(fmt::format("{}: holds more than the {} bytes expected", file.string(), limit));
    bytes.resize(size);
    return bytes;
}

void writeFileAtomically(const fs::path& file, std::string_view bytes) {
    TemporaryFile temporary(file);
    temporary.write(bytes);
    temporary.becomeFile();
}

void checkWritable(const fs::path& file) { const TemporaryFile temporary(file); }

} // namespace penumbra
