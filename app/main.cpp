// SPDX-License-Identifier: MIT
#include "app/capture.h"
#include "app/command_line.h"
#include "app/list.h"
#include "app/measure.h"
#include "app/window.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <malloc.h>

using namespace penumbra;

namespace {

int openWindow(const Options& options) {
    if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY"))
        throw InputError("there is no display to open a window on (neither DISPLAY nor WAYLAND_DISPLAY is set); "
                         "'penumbra capture' renders without one");
    Shot shot;
    Session session = makeSession(options, shot);
    return runWindow(session, session.size);
}

int run(const Options& options) {
    int exitCode = 0;
    switch (options.verb) {
    case Verb::Window: return openWindow(options);
    case Verb::Capture: capture(options); break;
    case Verb::Measure: exitCode = measure(options); break;
    case Verb::List: list(options); break;
    }
    if (std::fflush(stdout) != 0) throw std::runtime_error("standard output could not be written");
    return exitCode;
}

int report(std::string message, int exitCode) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    fmt::print(stderr, "penumbra: {}\n", message);
    return exitCode;
}

} // namespace

int main(int argc, char** argv) {
    // What a scene took while it was loading goes back to the system at once: without this, glibc keeps blocks of up to
    // 32 MiB, those of each loading thread for itself.
    mallopt(M_MMAP_THRESHOLD, 4 << 20);
    try {
        const std::optional<Options> options = parseCommandLine(argc, argv);
        return options ? run(*options) : 0;
    } catch (const InputError& error) {
        return report(error.what(), 2);
    } catch (const std::bad_alloc&) {
        return report("out of memory", 1);
    } catch (const std::exception& error) {
        return report(error.what(), 1);
    }
}
