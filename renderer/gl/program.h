// SPDX-License-Identifier: MIT
// Programs from files below shaders/: #include, defines, the parameter block; errors at our own file and line;
// recompiled when a file changes on disk while the last good program keeps running.
#pragma once

#include "renderer/core/flow.h"
#include "renderer/gl/handle.h"

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace penumbra {

enum class ProgramKind { Compute, Raster }; // Raster: one file with VERTEX_SHADER and FRAGMENT_SHADER parts

// The sampler of a material's texture, which the geometry binds and not the pass.
inline constexpr std::string_view materialSampler = "baseColourTexture";

// The uniform of shaders/band.glsl.
inline constexpr std::string_view bandOriginUniform = "bandOrigin";
// What follows the name of a tile set in its block's; see shaders/tiles.glsl.
inline constexpr std::string_view tileBlockEnding = "Tiles";

// A linked program and where its samplers and images are bound: units 0, 1, 2 ... by name, the material's texture last,
// so that the variants of a pass agree.
class Program {
public:
    struct Binding {
        std::string name;
        GLuint unit;
    };
    GLuint name() const { return handle_.get(); }
    // Of arrays each element, as "name[0]".
    const std::vector<Binding>& samplers() const { return samplers_; }
    const std::vector<Binding>& images() const { return images_; }
    const std::vector<Binding>& tileSets() const { return tileSets_; } // by the name of the set
    // Of the uniform that says where a band of a compute pass begins, see shaders/band.glsl; −1: it has none.
    GLint bandOrigin() const { return bandOrigin_; }
    // Whether the source text says this word, or this array's: a read that no variant of the shader could use is a
    // mistake.
    bool mentions(std::string_view word) const;

private:
    friend class ProgramLibrary;
    static void destroy(GLuint name) { glDeleteProgram(name); }
    Handle<destroy> handle_;
    std::vector<Binding> samplers_, images_, tileSets_;
    GLint bandOrigin_ = -1;
    std::string source_;
};

// The complete text of a program's stages, and the files it was put together from (the second number of #line).
struct ProgramText {
    struct StageText {
        GLenum stage;
        std::string text;
    };
    std::vector<StageText> stages;
    std::vector<std::filesystem::path> files; // relative to the shader folder
    std::string body;                         // without the head: version, defines, parameter block
};
// Throws std::runtime_error if a file cannot be read; `files` names it all the same.
void assemble(const std::filesystem::path& folder, ProgramKind kind, std::string_view shader, const Defines& defines,
              std::string_view parameterText, ProgramText& text);

class ProgramLibrary {
public:
    explicit ProgramLibrary(std::filesystem::path folder) : folder_(std::move(folder)) {}

    // Compiled at first use. Throws std::runtime_error with our file and line if it never compiled.
    const Program& get(ProgramKind kind, std::string_view shader, const Defines& defines,
                       const ParameterSet* parameters);

    // Recompiles what changed on disk since; looks at most twice a second. Returns the errors of files whose newest
    // text does not compile, one text each.
    const std::vector<std::string>& poll();
    // How often poll() has recompiled something: another number, another picture.
    uint64_t generation() const { return generation_; }

private:
    struct File {
        std::filesystem::path path;
        std::filesystem::file_time_type time;
    };
    struct Entry {
        ProgramKind kind;
        std::string shader;
        Defines defines;
        std::string owner;               // of the parameters
        std::vector<uint32_t> constants; // their values that are compiled in
        std::string parameterText;
        Program program;
        std::vector<File> files;
        std::string error;
    };
    void build(Entry& entry) const;

    std::filesystem::path folder_;
    std::vector<std::unique_ptr<Entry>> entries_;
    std::vector<std::string> errors_;
    std::chrono::steady_clock::time_point lastPoll_{};
    uint64_t generation_ = 0;
};

} // namespace penumbra
