// SPDX-License-Identifier: GPL-3.0-or-later
// Origins follow RFC 6454: scheme, host and port. Requests with another Host are refused, which
// defeats DNS rebinding; the policy of contents lets the page load from this server alone.
#include "extensions/web/web_files.h"

#include <algorithm>
#include <array>

// The assembler copies the files into the program; CMake passes their folder.
// NOLINTBEGIN(hicpp-no-assembler,bugprone-macro-parentheses)
#define ISPACE_WEB_FILE(symbol, file)                                                       \
    asm(".pushsection .rodata\n" #symbol ":\n.incbin \"" ISPACE_WEB "/" file "\"\n" #symbol \
        "End:\n.popsection\n");                                                             \
    extern "C" const char symbol[], symbol##End[]
// NOLINTEND(hicpp-no-assembler,bugprone-macro-parentheses)

ISPACE_WEB_FILE(kWebPage, "index.html");
ISPACE_WEB_FILE(kWebStyle, "style.css");
ISPACE_WEB_FILE(kWebIcon, "icon.svg");
ISPACE_WEB_FILE(kWebMain, "main.js");
ISPACE_WEB_FILE(kWebLink, "link.js");
ISPACE_WEB_FILE(kWebView, "view.js");
ISPACE_WEB_FILE(kWebPlan, "plan.js");
ISPACE_WEB_FILE(kWebMovers, "movers.js");
ISPACE_WEB_FILE(kWebDrive, "drive.js");
ISPACE_WEB_FILE(kWebEvents, "events.js");
ISPACE_WEB_FILE(kWebCamera, "camera.js");
ISPACE_WEB_FILE(kWebSeek, "seek.js");
ISPACE_WEB_FILE(kWebStates, "states.js");
ISPACE_WEB_FILE(kWebBuilding, "building.js");
ISPACE_WEB_FILE(kWebPace, "pace.js");
ISPACE_WEB_FILE(kWebHistory, "history.js");
ISPACE_WEB_FILE(kWebClock, "clock.js");
ISPACE_WEB_FILE(kWebEdit, "edit.js");
ISPACE_WEB_FILE(kWebLayers, "layers.js");
ISPACE_WEB_FILE(kWebMarks, "marks.js");
ISPACE_WEB_FILE(kWebSpace, "space.js");
ISPACE_WEB_FILE(kWebTools, "tools.js");

namespace ispace::web {

const WebFile* webFile(std::string_view path) {
    const auto between = [](const char* begin, const char* end) {
        return std::string_view(begin, static_cast<std::size_t>(end - begin));
    };
    constexpr std::string_view kScript = "text/javascript; charset=utf-8";
    static const std::array<WebFile, 22> files = {{
        {"/", "text/html; charset=utf-8", between(kWebPage, kWebPageEnd)},
        {"/style.css", "text/css; charset=utf-8", between(kWebStyle, kWebStyleEnd)},
        {"/icon.svg", "image/svg+xml", between(kWebIcon, kWebIconEnd)},
        {"/main.js", kScript, between(kWebMain, kWebMainEnd)},
        {"/link.js", kScript, between(kWebLink, kWebLinkEnd)},
        {"/view.js", kScript, between(kWebView, kWebViewEnd)},
        {"/plan.js", kScript, between(kWebPlan, kWebPlanEnd)},
        {"/movers.js", kScript, between(kWebMovers, kWebMoversEnd)},
        {"/drive.js", kScript, between(kWebDrive, kWebDriveEnd)},
        {"/events.js", kScript, between(kWebEvents, kWebEventsEnd)},
        {"/camera.js", kScript, between(kWebCamera, kWebCameraEnd)},
        {"/seek.js", kScript, between(kWebSeek, kWebSeekEnd)},
        {"/states.js", kScript, between(kWebStates, kWebStatesEnd)},
        {"/building.js", kScript, between(kWebBuilding, kWebBuildingEnd)},
        {"/history.js", kScript, between(kWebHistory, kWebHistoryEnd)},
        {"/pace.js", kScript, between(kWebPace, kWebPaceEnd)},
        {"/clock.js", kScript, between(kWebClock, kWebClockEnd)},
        {"/edit.js", kScript, between(kWebEdit, kWebEditEnd)},
        {"/layers.js", kScript, between(kWebLayers, kWebLayersEnd)},
        {"/marks.js", kScript, between(kWebMarks, kWebMarksEnd)},
        {"/space.js", kScript, between(kWebSpace, kWebSpaceEnd)},
        {"/tools.js", kScript, between(kWebTools, kWebToolsEnd)},
    }};
    const auto* const found = std::find_if(files.begin(), files.end(),
                                           [&](const WebFile& file) { return file.path == path; });
    return found == files.end() ? nullptr : found;
}

namespace {

constexpr std::uint16_t kHttpPort = 80;
constexpr std::string_view kScheme = "http://";

bool equalIgnoringCase(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [&](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

WebOrigin::WebOrigin(const std::string& address, std::uint16_t port) {
    const std::string suffix = ":" + std::to_string(port);
    for (const std::string& name : {address, std::string("localhost")}) {
        hosts_.push_back(name + suffix);
        if (port == kHttpPort) hosts_.push_back(name);
    }
}

bool WebOrigin::isHost(std::string_view host) const {
    return std::any_of(hosts_.begin(), hosts_.end(),
                       [&](const std::string& known) { return equalIgnoringCase(host, known); });
}

bool WebOrigin::mayConnect(std::string_view origin) const {
    return origin.empty() || (origin.starts_with(kScheme) && isHost(origin.substr(kScheme.size())));
}

std::string contentPolicy(std::string_view host) {
    std::string out =
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src "
        "'self' ws://";
    return out.append(host).append("; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
}

}  // namespace ispace::web
