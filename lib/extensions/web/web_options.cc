// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/web/web_options.h"

#include <optional>
#include <string>

#include "base/error.h"
#include "base/message.h"
#include "extensions/web/web_page.h"
#include "io/glb/glb_write.h"
#include "scene/run/run_marks.h"

namespace ispace::web {

namespace {

class WebOptions final : public BridgeGroup {
  public:
    void declare(CommandLine& line) override;
    void take(BridgeRules& rules) override;
    [[nodiscard]] std::size_t connections() const override { return 0; }
    void open(Server& server, Simulation& simulation, const BridgeRun& run) override;
    void announce(JsonWriter& json) const override;

  private:
    std::optional<Endpoint> endpoint_;
    bool edits_ = false;
    std::string address_;
};

void WebOptions::declare(CommandLine& line) {
    line.group("The page");
    line.parsed(
        "--web", "ADDR:PORT",
        [this](const std::string& text) {
            endpoint_ = parseEndpoint(text);
            if (!endpoint_->is_loopback)
                throw UsageError(excerpt(text) +
                                 ": the page is for browsers of this machine; use 127.0.0.1");
        },
        "show the running world to browsers there; port 0 takes any free one", Enters::Nothing);
    line.flag("--web-edit", edits_,
              "let that page add, move, turn and delete things, sensors and people, and save the "
              "room",
              Enters::Nothing);
    line.essential({"--web", "--web-edit"});
}

void WebOptions::take(BridgeRules& rules) {
    if (edits_ && !endpoint_) throw UsageError("--web-edit requires --web ADDR:PORT");
    if (edits_ && (!rules.limits.changes || rules.is_replay))
        throw UsageError(std::string("--web-edit changes the room of a run, which ") +
                         (rules.is_replay ? "--replay" : "--no-changes") + " does not allow");
}

void WebOptions::open(Server& server, Simulation& /*simulation*/, const BridgeRun& run) {
    if (!endpoint_) return;
    address_ = serveWeb(server, *endpoint_, run.title,
                        {.edits = edits_,
                         .marks = recordedMarks(run.replayed),
                         .mesh = [](const Scene& scene) { return writeRoomGlb(scene); }});
}

void WebOptions::announce(JsonWriter& json) const {
    if (!address_.empty()) json.key("web").value(address_);
}

}  // namespace

std::unique_ptr<BridgeGroup> makeWebOptions() { return std::make_unique<WebOptions>(); }

}  // namespace ispace::web
