// SPDX-License-Identifier: MIT
#include "app/window.h"

#include "app/file_io.h"
#include "app/image_file.h"
#include "app/preset.h"
#include "app/session_facts.h"
#include "app/settings.h"
#include "app/truth_cache.h"
#include "renderer/core/paths.h"
#include "ui/workspace.h"

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <ctime>

namespace penumbra {

namespace {

namespace fs = std::filesystem;

constexpr float fontHeight = 15;                                 // pixels at 96 dots per inch
constexpr int settlingFrames = 4;                                // that ImGui needs to answer an input
constexpr double tapSeconds = 0.05;                              // how long a key counts as held at least
constexpr double doubleClickSeconds = 0.4, doubleClickReach = 6; // window units at 96 dots per inch
constexpr double longestHold = 0.25; // in one frame [s]; after a pause of the program nothing leaps

std::string& lastGlfwError() {
    static std::string text;
    return text;
}

class Glfw {
public:
    Glfw() {
        glfwSetErrorCallback([](int, const char* text) { lastGlfwError() = text; });
        if (!glfwInit())
            throw InputError(
                fmt::format("there is no display for a window ({}); `penumbra capture` needs none", lastGlfwError()));
    }
    ~Glfw() { glfwTerminate(); }
    Glfw(const Glfw&) = delete;
};

// The part of the first monitor that a window may cover.
glm::ivec2 largestWindow() {
    int x = 0, y = 0, width = 0, height = 0;
    if (GLFWmonitor* monitor = glfwGetPrimaryMonitor()) glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
    return width > 0 && height > 0 ? glm::ivec2(width, height) : glm::ivec2(16384);
}

// What the callbacks hear; taken once a frame.
struct Heard {
    Keys struck;
    int textSteps = 0; // to larger text, or smaller
    bool textReset = false;
    std::vector<std::string> dropped;
    std::vector<int> pressed;                        // keys that went down
    std::vector<std::pair<int, int>> releasedAtOnce; // keys and modifiers that went down and up
};

class Window {
public:
    explicit Window(glm::ivec2 size) {
        glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
        glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
        glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
        glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
        glfwWindowHintString(GLFW_X11_CLASS_NAME, "penumbra");
        window_ = glfwCreateWindow(size.x, size.y, "Penumbra", nullptr, nullptr);
        if (!window_)
            throw InputError(
                fmt::format("the window needs OpenGL 4.5, which this display does not offer ({})", lastGlfwError()));
        glm::ivec2 scaled(0);
        glfwGetWindowSize(window_, &scaled.x, &scaled.y);
        const glm::ivec2 fitting = glm::min(scaled, largestWindow());
        if (fitting != scaled) glfwSetWindowSize(window_, fitting.x, fitting.y);
        glfwMakeContextCurrent(window_);
        glfwSwapInterval(1);
        glfwSetWindowUserPointer(window_, this);
        glfwSetDropCallback(window_, onDrop);
    }
    ~Window() { glfwDestroyWindow(window_); }
    Window(const Window&) = delete;

    GLFWwindow* get() const { return window_; }
    bool open() const { return !glfwWindowShouldClose(window_); }
    Heard take() { return std::exchange(heard_, {}); }
    // Hears keys and buttons before ImGui, which must have installed its callbacks already.
    void hearInput() {
        glfwSetKeyCallback(window_, onKey);
        glfwSetMouseButtonCallback(window_, onButton);
    }

    bool visible() const {
        const glm::ivec2 pixels = framebufferSize();
        return glfwGetWindowAttrib(window_, GLFW_VISIBLE) && !glfwGetWindowAttrib(window_, GLFW_ICONIFIED) &&
               pixels.x > 0 && pixels.y > 0;
    }
    glm::ivec2 framebufferSize() const {
        glm::ivec2 size(0);
        glfwGetFramebufferSize(window_, &size.x, &size.y);
        return size;
    }
    // Pixels of the framebuffer per unit of window coordinates.
    float pixelsPerUnit() const {
        int width = 0, height = 0;
        glfwGetWindowSize(window_, &width, &height);
        return width > 0 ? static_cast<float>(framebufferSize().x) / static_cast<float>(width) : 1.0f;
    }
    // Pixels of the framebuffer per dot at 96 dots per inch.
    float contentScale() const {
        float x = 1, y = 1;
        glfwGetWindowContentScale(window_, &x, &y);
        return std::isfinite(x) ? std::clamp(x, 0.5f, 8.0f) : 1.0f;
    }
    bool down(int key) const { return glfwGetKey(window_, key) == GLFW_PRESS; }
    // How long the key was down since this was last asked [s].
    float secondsDown(int key);

private:
    static Heard& heard(GLFWwindow* window) { return of(window).heard_; }
    static void onKey(GLFWwindow* window, int key, int code, int action, int modifiers);
    static void onButton(GLFWwindow* window, int button, int action, int modifiers);
    static void onStroke(GLFWwindow* window, int key, int modifiers);
    static void onDrop(GLFWwindow* window, int count, const char** paths) {
        for (int i = 0; i < count; ++i) heard(window).dropped.push_back(paths[i]);
    }

    // Of a key: whether and since when it is down, and how long it was before [s].
    struct Hold {
        bool down = false;
        double since = 0, seconds = 0;
    };
    static Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

    GLFWwindow* window_ = nullptr;
    Heard heard_;
    std::array<Hold, GLFW_KEY_LAST + 1> holds_{};
    double lastClick_ = -1; // of the left button [s], and where
    glm::dvec2 lastPlace_{0};
};

// A context for another thread; it may share a window's objects, to fill them.
class HiddenContext {
public:
    explicit HiddenContext(GLFWwindow* shared) {
        glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
        window_ = glfwCreateWindow(1, 1, "", nullptr, shared);
        if (!window_) throw InputError(fmt::format("there is no second OpenGL context ({})", lastGlfwError()));
    }
    ~HiddenContext() { glfwDestroyWindow(window_); }
    HiddenContext(const HiddenContext&) = delete;
    SideContext::MakeCurrent makeCurrent() const {
        return [window = window_](bool current) { glfwMakeContextCurrent(current ? window : nullptr); };
    }

private:
    GLFWwindow* window_ = nullptr;
};

// GLFW names keys after their place on an American keyboard: where a letter is printed elsewhere, that is the one
// meant.
int keyOfLetter(int key, int code) {
    const char* printed = glfwGetKeyName(key, code);
    if (!printed || printed[0] == 0 || printed[1] != 0) return key;
    const char letter = printed[0];
    if (letter >= 'a' && letter <= 'z') return GLFW_KEY_A + (letter - 'a');
    return letter == '+' ? GLFW_KEY_EQUAL : letter == '-' ? GLFW_KEY_MINUS : key;
}

// ImGui 1.86 looks at which keys are down once a frame: a key that went down and up within a slow frame would be lost,
// so that its release is told a frame later.
void Window::onKey(GLFWwindow* window, int key, int code, int action, int modifiers) {
    std::vector<int>& pressed = heard(window).pressed;
    if (key >= 0 && action != GLFW_REPEAT) {
        const int meant = keyOfLetter(key, code);
        // Flight keys are those of that place, whatever is printed on them.
        const bool sign = meant == GLFW_KEY_EQUAL || meant == GLFW_KEY_MINUS;
        Hold& hold = of(window).holds_[static_cast<size_t>(sign ? meant : key)];
        hold.seconds += action == GLFW_PRESS ? tapSeconds : glfwGetTime() - hold.since;
        hold.since = glfwGetTime();
        hold.down = action == GLFW_PRESS;
    }
    if (action == GLFW_PRESS) {
        pressed.push_back(key);
        onStroke(window, keyOfLetter(key, code), modifiers);
    }
    if (action == GLFW_RELEASE && std::find(pressed.begin(), pressed.end(), key) != pressed.end())
        heard(window).releasedAtOnce.push_back({key, modifiers});
    else
        ImGui_ImplGlfw_KeyCallback(window, key, code, action, modifiers);
}

// Two clicks within a slow frame are one to ImGui 1.86.
void Window::onButton(GLFWwindow* window, int button, int action, int modifiers) {
    if (button == GLFW_MOUSE_BUTTON_LEFT && action == GLFW_PRESS) {
        Window& self = of(window);
        glm::dvec2 place(0);
        glfwGetCursorPos(window, &place.x, &place.y);
        const double now = glfwGetTime(), reach = doubleClickReach * static_cast<double>(self.contentScale());
        const bool twice = self.lastClick_ >= 0 && now - self.lastClick_ < doubleClickSeconds &&
                           glm::distance(place, self.lastPlace_) < reach;
        self.heard_.struck.doubleClick = self.heard_.struck.doubleClick || twice;
        self.lastClick_ = twice ? -1 : now;
        self.lastPlace_ = place;
    }
    ImGui_ImplGlfw_MouseButtonCallback(window, button, action, modifiers);
}

float Window::secondsDown(int key) {
    Hold& hold = holds_[static_cast<size_t>(key)];
    const double now = glfwGetTime();
    const double seconds = hold.seconds + (hold.down ? now - hold.since : 0);
    hold = {hold.down, now, 0};
    return static_cast<float>(std::min(seconds, longestHold));
}

void Window::onStroke(GLFWwindow* window, int key, int modifiers) {
    Keys& struck = heard(window).struck;
    const bool control = modifiers & GLFW_MOD_CONTROL;
    if (key == GLFW_KEY_ESCAPE) struck.escape = true;
    if (key == GLFW_KEY_F12) (modifiers & GLFW_MOD_SHIFT ? struck.windowPicture : struck.picture) = true;
    if (key == GLFW_KEY_F1) struck.help = true;
    if (control && key == GLFW_KEY_Q) glfwSetWindowShouldClose(window, GLFW_TRUE);
    if (control && key == GLFW_KEY_O) struck.open = true;
    if (control && (key == GLFW_KEY_EQUAL || key == GLFW_KEY_KP_ADD)) ++heard(window).textSteps;
    if (control && (key == GLFW_KEY_MINUS || key == GLFW_KEY_KP_SUBTRACT)) --heard(window).textSteps;
    if (control && (key == GLFW_KEY_0 || key == GLFW_KEY_KP_0)) heard(window).textReset = true;
    // Plain letters belong to whoever is being typed into.
    if (control || ImGui::GetIO().WantTextInput) return;
    switch (key) {
    case GLFW_KEY_H: struck.help = true; break;
    case GLFW_KEY_F: struck.frameScene = true; break;
    case GLFW_KEY_HOME: struck.reset = true; break;
    case GLFW_KEY_C: struck.next = true; break;
    case GLFW_KEY_G: struck.handles = true; break;
    case GLFW_KEY_R: struck.restart = true; break;
    case GLFW_KEY_V: struck.show = true; break;
    case GLFW_KEY_SPACE: struck.play = true; break;
    case GLFW_KEY_B: struck.buffers = true; break;
    case GLFW_KEY_T: struck.timings = true; break;
    case GLFW_KEY_Y: struck.truth = true; break;
    case GLFW_KEY_U: struck.ruler = true; break;
    case GLFW_KEY_X: struck.exchange = true; break;
    case GLFW_KEY_0: struck.alone = true; break;
    case GLFW_KEY_1: struck.wipe = true; break;
    case GLFW_KEY_2: struck.flip = true; break;
    case GLFW_KEY_3: struck.sideBySide = true; break;
    case GLFW_KEY_4: struck.errorMap = true; break;
    case GLFW_KEY_M: struck.tradeOff = true; break;
    case GLFW_KEY_J: struck.motion = true; break;
    case GLFW_KEY_P: struck.probe = true; break;
    case GLFW_KEY_K: struck.freeze = true; break;
    case GLFW_KEY_N: (modifiers & GLFW_MOD_SHIFT ? struck.runTo : struck.step) = true; break;
    default: break;
    }
}

Keys keysOf(Window& window, const Keys& struck) {
    Keys keys = struck;
    keys.shift = window.down(GLFW_KEY_LEFT_SHIFT) || window.down(GLFW_KEY_RIGHT_SHIFT);
    keys.control = window.down(GLFW_KEY_LEFT_CONTROL) || window.down(GLFW_KEY_RIGHT_CONTROL);
    const bool typing = ImGui::GetIO().WantTextInput;
    keys.light = !typing && window.down(GLFW_KEY_L);
    const auto held = [&](int key) {
        const float seconds = window.secondsDown(key);
        return typing ? 0 : seconds;
    };
    keys.forward = held(GLFW_KEY_W);
    keys.back = held(GLFW_KEY_S);
    keys.left = held(GLFW_KEY_A);
    keys.right = held(GLFW_KEY_D);
    keys.rise = held(GLFW_KEY_E);
    keys.sink = held(GLFW_KEY_Q);
    keys.arrowLeft = held(GLFW_KEY_LEFT);
    keys.arrowRight = held(GLFW_KEY_RIGHT);
    keys.arrowUp = held(GLFW_KEY_UP);
    keys.arrowDown = held(GLFW_KEY_DOWN);
    keys.nearer = held(GLFW_KEY_PAGE_UP);
    keys.further = held(GLFW_KEY_PAGE_DOWN);
    keys.smaller = held(GLFW_KEY_COMMA);
    keys.larger = held(GLFW_KEY_PERIOD);
    keys.slow = held(GLFW_KEY_MINUS);
    keys.fast = held(GLFW_KEY_EQUAL);
    if (keys.control) keys.slow = keys.fast = 0; // the size of text
    return keys;
}

class Gui {
public:
    explicit Gui(Window& window) : window_(window) {
        IMGUI_CHECKVERSION();
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr; // written by keepLayout, as a whole
        ImGui::GetIO().ConfigDragClickToInputText = true;
        ImGui_ImplGlfw_InitForOpenGL(window.get(), true);
        window.hearInput();
        ImGui_ImplOpenGL3_Init("#version 450 core");
        std::error_code ignored;
        if (const fs::path file = layoutFile(); fs::is_regular_file(file, ignored)) try {
                const std::string text = readFile(file, 1 << 20);
                ImGui::LoadIniSettingsFromMemory(text.data(), text.size());
            } catch (const InputError&) {
                // A layout that cannot be read is not worth a word: the window starts with its own.
            }
    }
    ~Gui() {
        ImGui_ImplOpenGL3_Shutdown();
        ImGui_ImplGlfw_Shutdown();
        ImGui::DestroyContext();
    }
    Gui(const Gui&) = delete;

    // Fits theme and font to the monitor; false: there is no font with Greek letters.
    bool fit() {
        const float dots = window_.contentScale() * textScale_, pixels = std::max(window_.pixelsPerUnit(), 0.01f);
        if (dots == dots_ && pixels == pixels_) return true;
        dots_ = dots;
        pixels_ = pixels;
        applyTheme(dots / pixels);
        const bool found = loadFont(std::round(fontHeight * dots));
        ImGui::GetIO().FontGlobalScale = 1 / pixels;
        ImGui_ImplOpenGL3_DestroyFontsTexture();
        ImGui_ImplOpenGL3_CreateFontsTexture();
        return found;
    }

    // By a tenth each; reset: as the monitor wants it.
    void scaleText(int steps, bool reset) {
        textSteps_ = reset ? 0 : std::clamp(textSteps_ + steps, -5, 20);
        textScale_ = 1 + 0.1f * static_cast<float>(textSteps_);
    }

    void begin() {
        ImGui_ImplOpenGL3_NewFrame();
        ImGui_ImplGlfw_NewFrame();
        ImGui::NewFrame();
    }

    void end() {
        ImGui::Render();
        const glm::ivec2 size = window_.framebufferSize();
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        glViewport(0, 0, size.x, size.y);
        glDisable(GL_SCISSOR_TEST);
        glClearColor(0, 0, 0, 1);
        glClear(GL_COLOR_BUFFER_BIT);
        ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
        keepLayout();
    }

private:
    static fs::path layoutFile() {
        const fs::path folder = configFolder();
        return folder.empty() ? folder : folder / "layout.ini";
    }
    static void keepLayout() {
        ImGuiIO& io = ImGui::GetIO();
        if (!io.WantSaveIniSettings) return;
        io.WantSaveIniSettings = false;
        const fs::path file = layoutFile();
        if (file.empty()) return;
        std::error_code ignored;
        fs::create_directories(file.parent_path(), ignored);
        size_t size = 0;
        const char* text = ImGui::SaveIniSettingsToMemory(&size);
        try {
            writeFileAtomically(file, {text, size});
        } catch (const InputError&) {
            // Where nothing can be kept, the next window starts with its own layout.
        }
    }

    Window& window_;
    float dots_ = 0, pixels_ = 0;
    int textSteps_ = 0;
    float textScale_ = 1;
};

// FOLDER/SCENE-TECHNIQUE-YYYYMMDD-HHMMSS or, of a buffer, FOLDER/SCENE-TECHNIQUE-WHAT-..., and the ending, with a
// number between where that is taken or promised.
class FileNames {
public:
    fs::path next(const fs::path& folder, const Session& session, std::string_view ending, std::string_view what = {}) {
        const std::time_t now = std::time(nullptr);
        std::tm local{};
        localtime_r(&now, &local);
        char moment[32];
        std::strftime(moment, sizeof(moment), "%Y%m%d-%H%M%S", &local);
        std::string name = fmt::format("{}-{}-{}{}{}", session.scene->name, session.techniques.card().id, what,
                                       what.empty() ? "" : "-", moment);
        std::replace_if(
            name.begin(), name.end(), [](unsigned char c) { return c < 32 || c == '/' || c == '\\'; }, '_');
        std::error_code ignored;
        fs::path file = folder / fmt::format("{}{}", name, ending);
        for (int i = 2; file == last_ || fs::exists(file, ignored); ++i)
            file = folder / fmt::format("{}-{}{}", name, i, ending);
        return last_ = file;
    }

private:
    fs::path last_; // perhaps still being written
};

void makeFolder(const fs::path& folder) {
    std::error_code ignored; // a folder that cannot be made shows when a file is written
    fs::create_directories(folder, ignored);
}

// RGB, bottom row first, as OpenGL gives them.
struct Pixels {
    glm::ivec2 size;
    std::vector<uint8_t> bytes;
    explicit Pixels(glm::ivec2 s) : size(s), bytes(3 * static_cast<size_t>(s.x) * static_cast<size_t>(s.y)) {}
};

// A part of what stands in the back buffer, from its lower left corner.
Pixels windowPixels(glm::ivec2 corner, glm::ivec2 size) {
    Pixels pixels(size);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    glReadBuffer(GL_BACK);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(corner.x, corner.y, size.x, size.y, GL_RGB, GL_UNSIGNED_BYTE, pixels.bytes.data());
    return pixels;
}
Pixels windowPixels(const Window& window) { return windowPixels({0, 0}, window.framebufferSize()); }

Pixels viewPixels(const Renderer& renderer) {
    const Texture& display = renderer.runner().texture(renderer.flow(), renderer.display());
    Pixels pixels({display.extent().width, display.extent().height});
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTextureImage(display.name(), 0, GL_RGB, GL_UNSIGNED_BYTE, static_cast<GLsizei>(pixels.bytes.size()),
                      pixels.bytes.data());
    return pixels;
}

Picture pictureOf(const Pixels& pixels) {
    Picture picture{pixels.size.x, pixels.size.y, {"R", "G", "B"}};
    picture.values.reserve(pixels.bytes.size());
    const size_t row = 3 * static_cast<size_t>(pixels.size.x);
    for (size_t y = static_cast<size_t>(pixels.size.y); y-- > 0;)
        for (size_t i = y * row; i < (y + 1) * row; ++i)
            picture.values.push_back(static_cast<float>(pixels.bytes[i]) / 255.0f);
    return picture;
}

Actions actionsOn(Session& session, const Renderer& renderer, const Window& window, Settings& settings,
                  FileNames& names, TruthCache& truthCache) {
    Actions actions;
    actions.truthCache = &truthCache;
    actions.readPicture = [](SceneRequest& request) {
        if (!mayHoldFacts(request.nameOrFile)) return;
        const auto facts = std::make_shared<const PictureFacts>(request.nameOrFile);
        request = {facts->scene().string(), facts->choice(), false, [facts](Session& restored) {
                       facts->restore(restored);
                       restored.frame = 0;
                       return facts->doubtAboutScene(*restored.scene);
                   }};
    };
    actions.presetNames = [] { return PresetNames{ownPresetNames(), builtInPresetNames()}; };
    actions.loadPreset = [&session](const std::string& name) { loadPreset(findPreset(name), session.techniques); };
    actions.savePreset = [&session](const std::string& name) {
        savePreset(userPresetFile(session.techniques.card().id, name), session.techniques);
    };
    actions.renamePreset = [&session](const std::string& name, const std::string& newName) {
        renamePreset(session.techniques.card().id, name, newName);
    };
    actions.deletePreset = [&session](const std::string& name) { deletePreset(session.techniques.card().id, name); };
    actions.savePicture = [&](bool wholeWindow) {
        const int frames = std::max(static_cast<int>(session.frame), 1);
        Json facts = factsOf(session, {.frames = frames, .panels = wholeWindow}, renderer.driver());
        Pixels pixels = wholeWindow ? windowPixels(window) : viewPixels(renderer);
        makeFolder(settings.pictures);
        // Compressing takes longer than a frame may.
        return std::async(std::launch::async, [file = names.next(settings.pictures, session, ".png"),
                                               pixels = std::move(pixels), facts = std::move(facts)] {
            writePicture(file, pictureOf(pixels), facts);
            return file;
        });
    };
    actions.saveBuffer = [&](const BufferShot& shot) {
        makeFolder(settings.pictures);
        const fs::path file = names.next(settings.pictures, session, shot.raw ? ".exr" : ".png", shot.label);
        const int frames = std::max(static_cast<int>(session.frame), 1);
        writePicture(file, shot.picture, factsOf(session, {.frames = frames, .buffer = shot.label}, renderer.driver()));
        return file;
    };
    actions.saveTimings = [&](const std::string& table) {
        makeFolder(settings.pictures);
        fs::path file = names.next(settings.pictures, session, "-timings.csv");
        writeFileAtomically(file, table);
        return file;
    };
    actions.saveChart = [&](ImVec2 corner, ImVec2 size) {
        const float scale = window.pixelsPerUnit();
        const glm::ivec2 whole = window.framebufferSize();
        const glm::ivec2 from = glm::clamp(glm::ivec2(scale * glm::vec2(corner.x, corner.y)), glm::ivec2(0), whole);
        const glm::ivec2 extent =
            glm::clamp(glm::ivec2(scale * glm::vec2(size.x, size.y)), glm::ivec2(1), glm::max(whole - from, 1));
        makeFolder(settings.pictures);
        const fs::path file = names.next(settings.pictures, session, ".png", "trade-off");
        writePicture(file, pictureOf(windowPixels({from.x, whole.y - from.y - extent.y}, extent)),
                     factsOf(session, {.panels = true}, renderer.driver()));
        return file;
    };
    actions.saveTradeOff = [&](const std::string& table) {
        makeFolder(settings.pictures);
        fs::path file = names.next(settings.pictures, session, "-trade-off.csv");
        writeFileAtomically(file, table);
        return file;
    };
    actions.picturesFolder = [&settings] { return settings.pictures; };
    actions.setPicturesFolder = [&settings](const fs::path& folder) {
        if (!folder.is_absolute())
            throw InputError(
                fmt::format("'{}': the whole path of a folder was expected, from '/' on", folder.string()));
        const Settings chosen{folder.lexically_normal()};
        makeFolder(chosen.pictures);
        checkWritable(chosen.pictures / "picture.png");
        saveSettings(chosen);
        settings = chosen;
    };
    return actions;
}

} // namespace

int runWindow(Session& session, glm::ivec2 size) {
    session.progressive = true;
    const Glfw glfw;
    Window window(size);
    Renderer renderer;
    Gui gui(window);
    const HiddenContext loadingContext(window.get()), measuringContext(nullptr), motionContext(nullptr);
    SceneLoader loader(loadingContext.makeCurrent());
    Settings settings = defaultSettings();
    std::string trouble;
    try {
        settings = loadSettings();
    } catch (const InputError& error) {
        trouble = error.what();
    }
    FileNames names;
    TruthFiles truthFiles;
    Actions actions = actionsOn(session, renderer, window, settings, names, truthFiles);
    actions.measuringContext = measuringContext.makeCurrent();
    actions.motionContext = motionContext.makeCurrent();
    Workspace workspace(session, renderer, loader, std::move(actions));
    if (!trouble.empty()) workspace.say(trouble);
    if (!gui.fit()) workspace.say("DejaVu Sans is not installed: Greek letters and signs show as '?'");
    glfwSetWindowTitle(window.get(), fmt::format("{} – Penumbra", session.scene->name).c_str());

    std::shared_ptr<const Scene> titled = session.scene;
    auto last = std::chrono::steady_clock::now();
    int framesAfterInput = settlingFrames;
    while (window.open()) {
        if (!window.visible()) {
            glfwWaitEvents();
            continue;
        }
        const double patience = framesAfterInput > 0 ? 0 : workspace.patience();
        if (patience <= 0) {
            glfwPollEvents();
            framesAfterInput = std::max(framesAfterInput - 1, 0);
        } else {
            const double start = glfwGetTime();
            glfwWaitEventsTimeout(patience);
            if (glfwGetTime() - start < patience) framesAfterInput = settlingFrames;
        }
        if (!window.visible()) continue;
        const auto now = std::chrono::steady_clock::now();
        const float seconds = std::chrono::duration<float>(now - last).count();
        last = now;

        Heard heard = window.take();
        if (!heard.dropped.empty()) workspace.openScene({std::move(heard.dropped.front())});
        gui.scaleText(heard.textSteps, heard.textReset);
        gui.fit();
        gui.begin();
        workspace.draw(keysOf(window, heard.struck), seconds, window.pixelsPerUnit());
        gui.end();
        workspace.drawn();
        for (const auto& [key, modifiers] : heard.releasedAtOnce)
            ImGui_ImplGlfw_KeyCallback(window.get(), key, glfwGetKeyScancode(key), GLFW_RELEASE, modifiers);
        glfwSwapBuffers(window.get());
        if (titled != session.scene) {
            titled = session.scene;
            glfwSetWindowTitle(window.get(), fmt::format("{} – Penumbra", titled->name).c_str());
        }
    }
    return 0;
}

} // namespace penumbra
