// SPDX-License-Identifier: MIT
#include "renderer/gl/program.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <sstream>
#include <tuple>

namespace penumbra {
namespace {

namespace fs = std::filesystem;

bool isWordCharacter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

// Text with #include "file" (relative to shaders/) expanded, each file once, and #line directives whose second number
// is the file's index in `files`.
class Preprocessor {
public:
    Preprocessor(const fs::path& folder, std::vector<fs::path>& found) : folder_(folder), files(found) {}

    std::string expand(const std::string& file) {
        if (std::find(files.begin(), files.end(), file) != files.end()) return {};
        const size_t index = files.size();
        files.push_back(file);
        std::ifstream stream(folder_ / file);
        if (!stream) throw std::runtime_error(fmt::format("shaders/{}: cannot be read", file));
        std::string text = fmt::format("#line 1 {}\n", index), line;
        for (int number = 1; std::getline(stream, line); ++number) {
            std::string included = includeOf(line);
            if (included.empty())
                text += line + '\n';
            else
                text += expand(included) + fmt::format("#line {} {}\n", number + 1, index);
        }
        return text;
    }

private:
    static std::string includeOf(const std::string& line) {
        constexpr std::string_view word = "#include \"";
        if (!line.starts_with(word)) return {};
        return line.substr(word.size(), line.find('"', word.size()) - word.size());
    }
    const fs::path& folder_;
    std::vector<fs::path>& files; // relative to the folder; named even when one is missing
};

// "0:12(3): error: ..." (Mesa) and "0(12) : error ..." (NVIDIA) become "shaders/lib/x.glsl:12: ...".
std::string atOurLines(const std::string& log, const std::vector<fs::path>& files) {
    static const std::regex place(R"(^(\d+)(?::(\d+)\(\d+\)|\((\d+)\)|:(\d+)) ?:)");
    std::istringstream lines(log);
    std::string result, line;
    while (std::getline(lines, line)) {
        std::smatch match;
        if (std::regex_search(line, match, place)) {
            const size_t file = std::stoul(match[1]);
            const std::string number = match[2].matched ? match[2] : match[3].matched ? match[3] : match[4];
            if (file < files.size())
                line = fmt::format("shaders/{}:{}:{}", files[file].string(), number, match.suffix().str());
        }
        if (!line.empty()) result += line + '\n';
    }
    return result;
}

struct ShaderDeleter {
    static void destroy(GLuint name) { glDeleteShader(name); }
};
using Shader = Handle<ShaderDeleter::destroy>;

Shader compile(GLenum stage, const std::string& text, const std::vector<fs::path>& files) {
    Shader shader(glCreateShader(stage));
    const char* source = text.c_str();
    glShaderSource(shader.get(), 1, &source, nullptr);
    glCompileShader(shader.get());
    GLint ok = 0, length = 0;
    glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &ok);
    if (!ok) {
        glGetShaderiv(shader.get(), GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<size_t>(std::max(length, 1)), '\0');
        glGetShaderInfoLog(shader.get(), length, nullptr, log.data());
        log.resize(log.find('\0'));
        throw std::runtime_error(atOurLines(log, files));
    }
    return shader;
}

bool isImage(GLenum type) { return type >= GL_IMAGE_1D && type <= GL_UNSIGNED_INT_IMAGE_2D_MULTISAMPLE_ARRAY; }

std::vector<uint32_t> programConstants(const ParameterSet* parameters) {
    std::vector<uint32_t> constants;
    if (parameters)
        for (const Parameter* p : parameters->all())
            if (p->spec().programConstant) constants.push_back(p->bits());
    return constants;
}

// Compares without building a list: get() runs for every pass of every frame.
bool sameConstants(const std::vector<uint32_t>& constants, const ParameterSet* parameters) {
    size_t i = 0;
    if (parameters)
        for (const Parameter* p : parameters->all())
            if (p->spec().programConstant && (i >= constants.size() || constants[i++] != p->bits())) return false;
    return i == constants.size();
}

} // namespace

bool Program::mentions(std::string_view word) const {
    word = word.substr(0, word.find('['));
    for (size_t at = source_.find(word); at != std::string::npos; at = source_.find(word, at + 1))
        if ((at == 0 || !isWordCharacter(source_[at - 1])) && !isWordCharacter(source_[at + word.size()])) return true;
    return false;
}

void assemble(const fs::path& folder, ProgramKind kind, std::string_view shader, const Defines& defines,
              std::string_view parameterText, ProgramText& text) {
    text.body = Preprocessor(folder, text.files).expand(std::string(shader));
    std::string head = "#version 450 core\n";
    for (const Define& define : defines) head += fmt::format("#define {} {}\n", define.name, define.value);
    head += parameterText;
    if (kind == ProgramKind::Compute)
        text.stages = {{GL_COMPUTE_SHADER, head + text.body}};
    else
        text.stages = {{GL_VERTEX_SHADER, head + "#define VERTEX_SHADER\n" + text.body},
                       {GL_FRAGMENT_SHADER, head + "#define FRAGMENT_SHADER\n" + text.body}};
}

void ProgramLibrary::build(Entry& entry) const {
    ProgramText text;
    const auto remember = [&] {
        entry.files.clear();
        for (const fs::path& file : text.files) {
            std::error_code missing;
            entry.files.push_back({file, fs::last_write_time(folder_ / file, missing)});
        }
    };
    try {
        assemble(folder_, entry.kind, entry.shader, entry.defines, entry.parameterText, text);
    } catch (const std::runtime_error&) {
        remember(); // so that the program is tried again when the file is back
        throw;
    }
    remember();

    Program program;
    program.handle_ = Handle<Program::destroy>(glCreateProgram());
    const GLuint name = program.name();
    for (const ProgramText::StageText& stage : text.stages)
        glAttachShader(name, compile(stage.stage, stage.text, text.files).get());
    glLinkProgram(name);
    GLint ok = 0, length = 0;
    glGetProgramiv(name, GL_LINK_STATUS, &ok);
    if (!ok) {
        glGetProgramiv(name, GL_INFO_LOG_LENGTH, &length);
        std::string log(static_cast<size_t>(std::max(length, 1)), '\0');
        glGetProgramInfoLog(name, length, nullptr, log.data());
        log.resize(log.find('\0'));
        throw std::runtime_error(fmt::format("shaders/{}: {}", entry.shader, log));
    }
    glObjectLabel(GL_PROGRAM, name, static_cast<GLsizei>(entry.shader.size()), entry.shader.data());

    struct Uniform {
        std::string name;
        GLint location;
        bool image;
        int count; // of an array
    };
    std::vector<Uniform> found;
    GLint uniforms = 0;
    glGetProgramInterfaceiv(name, GL_UNIFORM, GL_ACTIVE_RESOURCES, &uniforms);
    for (GLuint i = 0; i < static_cast<GLuint>(uniforms); ++i) {
        constexpr GLenum properties[] = {GL_TYPE, GL_LOCATION, GL_BLOCK_INDEX, GL_ARRAY_SIZE};
        GLint values[4] = {};
        glGetProgramResourceiv(name, GL_UNIFORM, i, 4, properties, 4, nullptr, values);
        if (values[2] != -1 || values[1] < 0) continue; // in a block
        char uniform[128] = {};
        glGetProgramResourceName(name, GL_UNIFORM, i, sizeof(uniform), nullptr, uniform);
        if (uniform == bandOriginUniform)
            program.bandOrigin_ = values[1];
        else
            found.push_back({uniform, values[1], isImage(static_cast<GLenum>(values[0])), values[3]});
    }
    std::sort(found.begin(), found.end(), [](const Uniform& a, const Uniform& b) {
        return std::tuple(a.name == materialSampler, a.name) < std::tuple(b.name == materialSampler, b.name);
    });
    for (const Uniform& uniform : found) {
        auto& bindings = uniform.image ? program.images_ : program.samplers_;
        const size_t bracket = uniform.name.find('['); // an array is called "name[0]"
        for (int i = 0; i < uniform.count; ++i) {
            const GLuint unit = static_cast<GLuint>(bindings.size());
            glProgramUniform1i(name, uniform.location + i, static_cast<GLint>(unit));
            bindings.push_back({bracket == std::string::npos
                                    ? uniform.name
                                    : fmt::format("{}[{}]", std::string_view(uniform.name).substr(0, bracket), i),
                                unit});
        }
    }
    GLint blocks = 0;
    glGetProgramInterfaceiv(name, GL_SHADER_STORAGE_BLOCK, GL_ACTIVE_RESOURCES, &blocks);
    for (GLuint i = 0; i < static_cast<GLuint>(blocks); ++i) {
        char title[128] = {};
        glGetProgramResourceName(name, GL_SHADER_STORAGE_BLOCK, i, sizeof(title), nullptr, title);
        std::string_view block = title;
        if (!block.ends_with(tileBlockEnding)) continue; // a buffer that the geometry binds
        block.remove_suffix(tileBlockEnding.size());
        const GLuint unit = static_cast<GLuint>(program.tileSets_.size());
        glShaderStorageBlockBinding(name, i, unit);
        program.tileSets_.push_back({std::string(block), unit});
    }
    program.source_ = std::move(text.body);
    entry.program = std::move(program);
}

const Program& ProgramLibrary::get(ProgramKind kind, std::string_view shader, const Defines& defines,
                                   const ParameterSet* parameters) {
    const std::string_view owner = parameters ? parameters->owner() : std::string_view();
    for (const auto& entry : entries_)
        if (entry->kind == kind && entry->shader == shader && entry->defines == defines && entry->owner == owner &&
            sameConstants(entry->constants, parameters))
            return entry->program;
    auto entry = std::make_unique<Entry>();
    entry->kind = kind;
    entry->shader = shader;
    entry->defines = defines;
    entry->owner = owner;
    entry->constants = programConstants(parameters);
    if (parameters) entry->parameterText = glslBlock(*parameters);
    build(*entry);
    entries_.push_back(std::move(entry));
    return entries_.back()->program;
}

const std::vector<std::string>& ProgramLibrary::poll() {
    const auto now = std::chrono::steady_clock::now();
    if (now - lastPoll_ < std::chrono::milliseconds(500)) return errors_;
    lastPoll_ = now;
    bool changed = false;
    for (const auto& entry : entries_) {
        const bool stale = std::any_of(entry->files.begin(), entry->files.end(), [&](const File& file) {
            std::error_code missing;
            return fs::last_write_time(folder_ / file.path, missing) != file.time;
        });
        if (!stale) continue;
        changed = true;
        entry->error.clear();
        try {
            build(*entry);
        } catch (const std::runtime_error& error) {
            entry->error = error.what();
        }
    }
    if (!changed) return errors_;
    ++generation_;
    errors_.clear();
    for (const auto& entry : entries_)
        if (!entry->error.empty() && std::find(errors_.begin(), errors_.end(), entry->error) == errors_.end())
            errors_.push_back(entry->error);
    return errors_;
}

} // namespace penumbra
