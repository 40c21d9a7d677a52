// SPDX-License-Identifier: GPL-3.0-or-later
// Requests of the Simulator TCP Protocol, in lines of two clients: those that begin with a tab are
// the second's. Each request has exactly one answer, however its bytes arrive. Inputs that begin
// with a line `building` are about two storeys with a lift and stairs, others about a room.
#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <span>

#include "base/number.h"
#include "cli/building_runs.h"
#include "extensions.h"
#include "fuzz.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "served_room.h"
#include "server/client_connection.h"
#include "server/session.h"
#include "sim/command.h"
#include "site/storeys.h"

namespace {

using namespace ispace;

constexpr std::size_t kMaxLine = 4096;

/// Lines as a connection cuts them, up to one that is too long.
std::vector<std::string> linesOf(std::string_view bytes, std::size_t piece) {
    LineBuffer buffer(kMaxLine);
    std::vector<std::string> lines;
    while (!bytes.empty()) {
        buffer.append(bytes.substr(0, piece));
        bytes.remove_prefix(std::min(piece, bytes.size()));
        while (buffer.ready() && !buffer.tooLong()) lines.emplace_back(buffer.take());
        if (buffer.tooLong()) break;
    }
    return lines;
}

/// Takes a line, and the bytes that a SCAN line announces at its end.
std::string_view takeLine(std::string_view& text) {
    constexpr std::string_view kBytes = " bytes=";
    const std::size_t end = text.find('\n');
    fuzz::require(end != std::string_view::npos, "half a line");
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end + 1);
    const std::size_t key = line.starts_with("SCAN ") ? line.find(kBytes) : std::string_view::npos;
    if (key == std::string_view::npos) return line;
    const auto bytes = parseInteger(line.substr(key + kBytes.size()));
    fuzz::require(bytes && static_cast<std::size_t>(*bytes) <= text.size(), "half a scan");
    text.remove_prefix(static_cast<std::size_t>(*bytes));
    return line;
}

/// Answers among the lines: all but events.
std::size_t answersIn(std::string_view text) {
    constexpr auto kEvents = std::to_array<std::string_view>({"DONE ", "FAIL ", "EVENT "});
    constexpr auto kAnswers = std::to_array<std::string_view>({"OK ", "SCAN ", "ERR "});
    std::size_t answers = 0;
    while (!text.empty()) {
        const std::string_view line = takeLine(text);
        const auto begins = [line](std::string_view word) { return line.starts_with(word); };
        const bool is_answer = std::any_of(kAnswers.begin(), kAnswers.end(), begins);
        fuzz::require(is_answer || std::any_of(kEvents.begin(), kEvents.end(), begins),
                      "a line that is neither answer nor event");
        answers += is_answer ? 1 : 0;
    }
    return answers;
}

SiteScene tower() {
    StoreyedDocument document = readBuilding(
        "- storey: {id: a, height: 3, records: &room [{fence: {id: f, path: [[0, 0], [6, 0], [6, "
        "4], "
        "[0, 4]], closed: yes}}]}\n"
        "- storey: {id: b, z: 3, height: 3, records: *room}\n"
        "- lift: {id: l, storeys: 'a,b', at: [-0.9, 2], heading: 0, size: [1.8, 1.8], door: 1.2}\n"
        "- stairs: {id: s, storeys: 'a,b', at: [2, 0.6], heading: 0, size: [1, 3]}\n",
        "tower.yaml", {});
    const Document layout = readRecordText(
        "#3dm 1\nrobot id=a/r1 at=3,2\nlaser id=a/l1 on=a/r1 at=0,0,0.2 fov=4 step=2\n"
        "human id=b/h1 at=3,2\nlaser id=b/l2 at=5,3 fov=4 step=2\n",
        "tower.3dm", sceneSchemas());
    const std::vector<Document> layouts = layoutsOf(layout, document);
    return makeSiteScene(std::move(document), layouts, {});
}

/// A building with the clock `step`, as ServedRoom.
class ServedTower {
  public:
    ServedTower() {
        rooms_.worlds = run_.get();
        for (const RunRoom& room : run_->rooms()) {
            states_.push_back(std::make_unique<ServerState>(*room.simulation));
            rooms_.states.push_back(states_.back().get());
        }
        for (const auto& state : states_) state->joinRooms(rooms_);
        run_->onMove([this](const std::string& mover, std::size_t from, std::size_t to) {
            rooms_.states[to]->takeOver(*rooms_.states[from], mover);
        });
    }
    [[nodiscard]] ServerState& state() { return *states_.front(); }
    template <typename Stepped>
    void run(Stepped stepped) {
        constexpr int kMaxSteps = 200;
        Simulation& simulation = *run_->rooms().front().simulation;
        for (int i = 0; i < kMaxSteps && simulation.owed() > 0; ++i) {
            simulation.run({}, std::chrono::nanoseconds(0));
            stepped();
        }
    }

  private:
    static BuildingRunOptions options() {
        BuildingRunOptions options;
        options.step = std::chrono::milliseconds(200);
        options.clock = {Clock::Kind::Step, 1};
        return options;
    }
    std::unique_ptr<BuildingWorlds> run_ = extensions().buildings().open(tower(), options());
    ServedRooms rooms_;
    std::vector<std::unique_ptr<ServerState>> states_;
};

class Client {
  public:
    explicit Client(ServerState& state) : session_(state) {}
    [[nodiscard]] bool mayAsk() const { return !session_.waiting() && !session_.closing(); }
    void ask(const std::string& line) {
        if (!wordsOf(line).empty()) ++due_;
        session_.request(line);
        settle();
    }
    void stepped() {
        session_.proceed();
        settle();
        if (const auto scan = session_.takeScan()) {
            std::string_view text = *scan;
            (void)takeLine(text);
            fuzz::require(text.empty(), "more than a scan");
        }
    }
    void finish() {
        session_.finish();
        settle();
        fuzz::require(due_ == 0, "a request without an answer");
    }

  private:
    void settle() {
        const std::size_t answers = answersIn(session_.take());
        fuzz::require(answers <= due_, "an answer without a request");
        due_ -= answers;
        fuzz::require(session_.waiting() || due_ == 0, "no answer to a request");
    }

    Session session_;
    std::size_t due_ = 0;  // answers
};

}  // namespace

namespace {

template <typename Room>
void talk(Room& room, std::span<const std::string> lines) {
    std::array<Client, 2> clients{Client(room.state()), Client(room.state())};
    for (const std::string& line : lines) {
        Client& client = clients[line.starts_with('\t') ? 1 : 0];
        if (client.mayAsk()) client.ask(line);
        room.run([&] {
            for (Client& each : clients) each.stepped();
        });
    }
    room.state().steps().cut();  // as at the end of a run
    for (Client& client : clients) client.finish();
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    const std::size_t piece = takePieceSize(bytes);
    const std::vector<std::string> lines = linesOf(bytes, std::string_view::npos);
    require(linesOf(bytes, piece) == lines, "other lines after pieces");
    const bool has_buildings = extensions().buildings().open != nullptr;
    if (has_buildings && !lines.empty() && lines.front() == "building") {
        ServedTower tower;
        return talk(tower, std::span(lines).subspan(1));
    }
    ServedRoom room;
    talk(room, lines);
}
