// SPDX-License-Identifier: MIT
// Shaders: valid for the reference compiler too, errors at our own lines, reloaded while the last good one runs on.
#include "renderer/core/paths.h"
#include "renderer/gl/program.h"
#include "tests/catch.h"
#include "tests/support/scenes.h"

#include <cstdlib>
#include <fstream>
#include <set>
#include <thread>

#include <unistd.h>

using namespace penumbra;
using namespace penumbra::test;
namespace fs = std::filesystem;

namespace {

struct TemporaryFolder {
    fs::path path = fs::temp_directory_path() / ("penumbra-shaders-" + std::to_string(::getpid()));
    TemporaryFolder() { fs::create_directories(path); }
    ~TemporaryFolder() { fs::remove_all(path); }
    void write(const fs::path& name, const std::string& text) const { std::ofstream(path / name) << text; }
};

std::string readText(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// All texts of all variants of the passes that a session's frame has, each handed to `each`.
template <class Each> void forEachStage(const Session& session, Each&& each) {
    (void)draw(session);
    for (const Flow::PassNode& pass : renderer().flow().passes()) {
        const std::string parameters = pass.parameters ? glslBlock(*pass.parameters) : std::string();
        const auto add = [&](ProgramKind kind, std::string_view shader, Defines defines, const char* variant) {
            if (variant) defines.push_back({variant});
            ProgramText text;
            assemble(shaderFolder(), kind, shader, defines, parameters, text);
            for (const ProgramText::StageText& stage : text.stages) each(stage, std::string(shader));
        };
        if (const Draw* work = std::get_if<Draw>(&pass.work)) {
            for (const char* variant : {static_cast<const char*>(nullptr), "TEXTURED", "MASKED"}) {
                add(ProgramKind::Raster, work->shader, work->defines, variant);
                Defines coloured = work->defines;
                coloured.push_back({"VERTEX_COLOURS"});
                add(ProgramKind::Raster, work->shader, coloured, variant);
            }
        } else if (const Compute* compute = std::get_if<Compute>(&pass.work)) {
            add(ProgramKind::Compute, compute->shader, compute->defines, nullptr);
        } else if (const PoseVertices* pose = std::get_if<PoseVertices>(&pass.work)) {
            add(ProgramKind::Compute, pose->shader, {}, nullptr);
        }
    }
}

} // namespace

TEST_CASE("every variant of every shader is valid GLSL 4.50 for glslangValidator") {
    if (std::system("glslangValidator --version >/dev/null 2>&1") != 0) {
        WARN("left out: glslangValidator is not installed");
        return;
    }
    const TemporaryFolder folder;
    std::set<std::string> seen, shaders;
    const auto validate = [&](const ProgramText::StageText& stage, const std::string& shader) {
        shaders.insert(shader);
        if (!seen.insert(stage.text).second) return;
        const char* ending = stage.stage == GL_COMPUTE_SHADER  ? ".comp"
                             : stage.stage == GL_VERTEX_SHADER ? ".vert"
                                                               : ".frag";
        const fs::path file = folder.path / (std::to_string(seen.size()) + ending);
        std::ofstream(file) << "// " << shader << "\n" << stage.text;
    };
    for (const Card* card : catalogue())
        for (const LightShape shape : {LightShape::Rectangle, LightShape::Disk, LightShape::Directional}) {
            Session s = quickSession(SceneBuilder().floor(2).build(), card->id);
            s.display.show = Show::Lit;
            s.light.shape = shape;
            const auto check = [&] { forEachStage(s, validate); };
            if (shape == LightShape::Rectangle) renderer().inspect({.probe = glm::ivec2(1, 1)});
            check();
            renderer().inspect({});
            for (Parameter* p : s.techniques.parameters().all()) {
                if (!p->spec().programConstant) continue;
                for (double value = p->spec().min; value <= p->spec().max; ++value) {
                    p->set(value);
                    check();
                }
                p->reset();
            }
        }
    // What only a moving scene needs.
    Session moving = session(wavingScene());
    forEachStage(moving, validate);
    moving.time = 0.1;
    forEachStage(moving, validate);
    CHECK(shaders.contains("pose.glsl"));
    for (const char* shader :
         {"inspect/paint.glsl", "inspect/sample.glsl", "inspect/measure.glsl", "inspect/copy.glsl"})
        for (const Defines& defines :
             {Defines{}, Defines{{"CHANNELS", 3}}, Defines{{"ARRAY"}}, Defines{{"MULTISAMPLED"}}}) {
            ProgramText text;
            assemble(shaderFolder(), ProgramKind::Compute, shader, defines, {}, text);
            validate(text.stages[0], shader);
        }
    CHECK(seen.size() > 20);
    const fs::path log = folder.path / "log";
    const int status =
        std::system(("cd " + folder.path.string() + " && glslangValidator *.comp *.vert *.frag >log").c_str());
    CAPTURE(readText(log));
    CHECK(status == 0);
}

TEST_CASE("a shader error is told at our own file and line, and the last good program runs on until it is mended") {
    (void)renderer(); // for its context
    const TemporaryFolder folder;
    const std::string good = "#include \"part.glsl\"\n"
                             "layout(local_size_x = 8, local_size_y = 8) in;\n"
                             "uniform writeonly image2D result;\n"
                             "void main() { imageStore(result, ivec2(0), vec4(part())); }\n";
    folder.write("main.glsl", good);
    folder.write("part.glsl", "// a comment\nfloat part() { return 1.0 }\n");
    ProgramLibrary library(folder.path);
    CHECK_THROWS_WITH(library.get(ProgramKind::Compute, "main.glsl", {}, nullptr), contains("shaders/part.glsl:2:"));

    folder.write("part.glsl", "float part() { return 1.0; }\n");
    const Program& program = library.get(ProgramKind::Compute, "main.glsl", {}, nullptr);
    const GLuint first = program.name();
    CHECK(library.poll().empty());

    const auto changed = [&](const std::string& name, const std::string& text) {
        // Two writes within the file system's clock tick would look like one.
        std::this_thread::sleep_for(std::chrono::milliseconds(600));
        folder.write(name, text);
    };
    changed("part.glsl", "float part() { return wrong; }\n"); // an included file
    REQUIRE(library.poll().size() == 1);
    CHECK_THAT(library.poll()[0], contains("shaders/part.glsl:1:"));
    CHECK(program.name() == first);

    changed("part.glsl", "float part() { return 0.5; }\n");
    CHECK(library.poll().empty());
    CHECK(program.name() != first);

    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    fs::remove(folder.path / "part.glsl");
    REQUIRE(library.poll().size() == 1);
    CHECK_THAT(library.poll()[0], contains("shaders/part.glsl: cannot be read"));
    forgetDriverMessages(); // the compiler's, as wanted
}
