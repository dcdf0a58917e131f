// SPDX-License-Identifier: MIT
// Does with a window what xdotool cannot: drops a file on it (the XDND protocol, version 5), asks it to close,
// minimises and restores it as a window manager does, and looks at its pixels.
//
//     person drop WINDOW FILE        person close|minimise|restore WINDOW        person look WINDOW X Y WIDTH HEIGHT
//
// Exit status 0 when the window has taken the file or the request was sent. `look` prints the
// colours, six hex digits a pixel.
#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

namespace {

class Person {
public:
    explicit Person(Window target) : target_(target) {}
    ~Person() { XCloseDisplay(display_); }

    void close() {
        send("WM_PROTOCOLS", static_cast<long>(atom("WM_DELETE_WINDOW")), CurrentTime);
        XSync(display_, False);
    }

    void minimise(bool away) {
        const long state[] = {away ? IconicState : NormalState, 0};
        XChangeProperty(display_, target_, atom("WM_STATE"), atom("WM_STATE"), 32, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(state), 2);
        away ? XUnmapWindow(display_, target_) : XMapWindow(display_, target_);
        XSync(display_, False);
    }

    bool drop(const std::string& file) {
        uris_ = "file://" + file + "\r\n";
        const Window root = DefaultRootWindow(display_);
        source_ = XCreateSimpleWindow(display_, root, 0, 0, 1, 1, 0, 0, 0);
        XSetSelectionOwner(display_, atom("XdndSelection"), source_, CurrentTime);
        const long source = static_cast<long>(source_);
        send("XdndEnter", source, 5L << 24, static_cast<long>(atom("text/uri-list")));
        send("XdndPosition", source, 0, (200L << 16) | 200, CurrentTime, static_cast<long>(atom("XdndActionCopy")));
        if (!waitFor("XdndStatus")) return false;
        send("XdndDrop", source, 0, CurrentTime);
        return waitFor("XdndFinished");
    }

    // The pixels of a rectangle, row by row, as 0xrrggbb.
    std::vector<unsigned long> look(int x, int y, unsigned width, unsigned height) {
        std::vector<unsigned long> pixels;
        XImage* image = XGetImage(display_, target_, x, y, width, height, AllPlanes, ZPixmap);
        if (!image) return pixels;
        for (int row = 0; row < image->height; ++row)
            for (int column = 0; column < image->width; ++column)
                pixels.push_back(XGetPixel(image, column, row) & 0xffffff);
        XDestroyImage(image);
        return pixels;
    }

private:
    Atom atom(const char* name) { return XInternAtom(display_, name, False); }

    void send(const char* type, long a, long b, long c = 0, long d = 0, long e = 0) {
        XEvent event{};
        event.xclient.type = ClientMessage;
        event.xclient.window = target_;
        event.xclient.message_type = atom(type);
        event.xclient.format = 32;
        const long data[] = {a, b, c, d, e};
        std::memcpy(event.xclient.data.l, data, sizeof(data));
        XSendEvent(display_, target_, False, NoEventMask, &event);
        XFlush(display_);
    }

    // Serves the list of files to whoever asks until this message comes; false after ten seconds.
    bool waitFor(const char* type) {
        const Atom wanted = atom(type);
        for (int i = 0; i < 1000; ++i) {
            while (XPending(display_)) {
                XEvent event;
                XNextEvent(display_, &event);
                if (event.type == ClientMessage && event.xclient.message_type == wanted) return true;
                if (event.type == SelectionRequest) answer(event.xselectionrequest);
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        std::fprintf(stderr, "person: no %s came\n", type);
        return false;
    }

    void answer(const XSelectionRequestEvent& request) {
        XChangeProperty(display_, request.requestor, request.property, request.target, 8, PropModeReplace,
                        reinterpret_cast<const unsigned char*>(uris_.data()), static_cast<int>(uris_.size()));
        XEvent event{};
        event.xselection.type = SelectionNotify;
        event.xselection.requestor = request.requestor;
        event.xselection.selection = request.selection;
        event.xselection.target = request.target;
        event.xselection.property = request.property;
        event.xselection.time = request.time;
        XSendEvent(display_, request.requestor, False, NoEventMask, &event);
        XFlush(display_);
    }

    Display* display_ = XOpenDisplay(nullptr);
    Window target_, source_ = 0;
    std::string uris_;
};

} // namespace

int main(int argc, char** argv) {
    const std::string verb = argc > 2 ? argv[1] : "";
    if (verb == "close" && argc == 3) {
        Person(std::strtoul(argv[2], nullptr, 0)).close();
        return 0;
    }
    if ((verb == "minimise" || verb == "restore") && argc == 3) {
        Person(std::strtoul(argv[2], nullptr, 0)).minimise(verb == "minimise");
        return 0;
    }
    if (verb == "drop" && argc == 4) return Person(std::strtoul(argv[2], nullptr, 0)).drop(argv[3]) ? 0 : 1;
    if (verb == "look" && argc == 7) {
        const auto number = [&](int i) { return std::atoi(argv[i]); };
        for (const unsigned long pixel :
             Person(std::strtoul(argv[2], nullptr, 0))
                 .look(number(3), number(4), static_cast<unsigned>(number(5)), static_cast<unsigned>(number(6))))
            std::printf("%06lx\n", pixel);
        return 0;
    }
    std::fprintf(stderr, "person: drop WINDOW FILE | close|minimise|restore WINDOW | look WINDOW X Y WIDTH HEIGHT\n");
    return 2;
}
