// SPDX-License-Identifier: MIT
// Does to a window what xdotool cannot: drops a file on it (the XDND protocol, version 5) and asks it to close as a
// window manager does.
//
//     person drop WINDOW FILE        person close WINDOW
//
// Exit status 0 when the window has taken the file or the request was sent.
#include <X11/Xatom.h>
#include <X11/Xlib.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>

namespace {

class Person {
public:
    explicit Person(Window target) : target_(target) {}
    ~Person() { XCloseDisplay(display_); }

    void close() {
        send("WM_PROTOCOLS", static_cast<long>(atom("WM_DELETE_WINDOW")), CurrentTime);
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
    if (verb == "drop" && argc == 4) return Person(std::strtoul(argv[2], nullptr, 0)).drop(argv[3]) ? 0 : 1;
    std::fprintf(stderr, "person: drop WINDOW FILE | close WINDOW\n");
    return 2;
}
