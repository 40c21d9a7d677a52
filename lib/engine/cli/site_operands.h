// SPDX-License-Identifier: GPL-3.0-or-later
// Operands that are rooms: one, or those of a building. Tools treat both alike: a room alone is a
// site of one room with the id "", and ids across a site are "STOREY/ID".
//
//     const SiteInput input = readSite({.operands = operands, .rules = rules});
//     for (const std::shared_ptr<const Scene>& room : input.rooms()) measure(*room);
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/operands.h"
#include "cli/storey_operands.h"
#include "env/zone.h"
#include "geom/pose.h"
#include "record/record.h"
#include "scene/findings/findings.h"
#include "scene/scene.h"
#include "site/coupling.h"
#include "site/site_scene.h"

namespace ispace {

/// The rooms that a tool was given, one or those of a building, and a layout of all of them.
struct SiteInput {
    std::string environment_operand, layout_operand;
    std::vector<std::string> named;  ///< as SceneInput::named
    std::vector<std::string> files;  ///< all that were read, for -MD
    std::optional<Document> layout;
    SiteScene building;                                   ///< of one room: roomAlone()
    std::vector<Diagnostic> warnings = {}, choices = {};  ///< of importers
    std::string storey = {};                              ///< as SceneInput::storey
    std::string storey_name = {};                         ///< as SceneInput::storey_name

    [[nodiscard]] bool isOneRoom() const { return building.isRoomAlone(); }
    /// Returns the scenes; equal storeys share one.
    [[nodiscard]] const std::vector<std::shared_ptr<const Scene>>& rooms() const {
        return building.scenes;
    }
    /// Returns the ids of the rooms; "" of one alone.
    [[nodiscard]] std::vector<std::string> ids() const;
    /// Returns the scene of a room alone, and its environment.
    [[nodiscard]] const Scene& only() const { return *building.scenes.front(); }
    [[nodiscard]] const Document& environment() const {
        return *building.document.storeys.front().room;
    }
    /// Returns the digest of the room's environment, or of the building.
    [[nodiscard]] std::string digest() const;
    /// Returns all records of the environment, for digests of jobs.
    [[nodiscard]] std::vector<Record> environmentRecords() const;
    /// Returns the id of a thing across the site: "ground/l1".
    [[nodiscard]] std::string idOf(std::size_t room, const std::string& id) const;
    /// Returns Storey::prefix() of a room.
    [[nodiscard]] std::string prefix(std::size_t room) const {
        return building.document.storeys[room].prefix();
    }

    /// Replaces the layout, and the scenes by those with it. \throws as makeScene(), layoutsOf()
    void setLayout(Document changed);
};

/// Reads ENV and LAYOUT: a room, a storey that --storey chooses, or a building. \throws as
/// readScene() and readBuildingInput()
SiteInput readSite(const SceneRequest& request);

/// The rooms of a site as sensors and viewers see them.
class SeenSite {
  public:
    /// \pre the input outlives it
    explicit SeenSite(const SiteInput& input);

    [[nodiscard]] const SiteInput& input() const { return *input_; }
    /// Returns how the rooms see each other; null of a room alone.
    [[nodiscard]] const Coupling* coupling() const { return coupling_ ? &*coupling_ : nullptr; }
    /// Returns the scene of a room with all that stands around it, and the robots and people there.
    [[nodiscard]] std::shared_ptr<const Scene> scene(std::size_t room) const;
    /// Returns the scene of a storey as seen from outside of the building, with the ids of the
    /// site. \pre it is one of a building
    [[nodiscard]] Scene fromOutside(std::size_t room) const;
    /// Returns the frame of a room in that of the site; empty of a room alone.
    [[nodiscard]] std::optional<Pose3> siteFromRoom(std::size_t room) const;
    /// Returns the room over whose floor a point of the site lies: the highest below the point with
    /// floor there, else the highest below it, else the lowest.
    [[nodiscard]] std::size_t roomAt(Point3 point) const;

  private:
    const SiteInput* input_;
    std::optional<Coupling> coupling_;
};

/// Returns the operands of a command that edits what was read: those given, and before them ENV if
/// the record `environment` of LAYOUT named it.
std::vector<std::string> operandsToEdit(const SiteInput& input);

/// The site with another layout.
struct OtherSite {
    SiteScene building;
    std::vector<std::string> files;  ///< that it was read from, for -MD
    std::vector<Diagnostic> warnings;
};
/// Reads it from `operand`, which may be - if stdin was not read yet. \throws as readSite(), and
/// FormatError if it is no layout
OtherSite readOtherLayout(const SiteInput& input, const std::string& operand,
                          const SceneRules& rules);

/// \throws UsageError unless the folder holds the record of a run of the site: of a room or, for a
/// storey read alone, of its building; of a building for several; as recordedBuilding() \param
/// option for messages
void mustBeRecordOf(const SiteInput& input, const std::string& option, const std::string& folder);

/// \throws UsageError for the record of a room, which is to be one of a building's run
[[noreturn]] void refuseRecordOfRoom(const SiteInput& building, const std::string& option,
                                     const std::string& folder);

/// Returns the folder of the site's record: of a storey that is read alone, its part of that of the
/// building. \pre mustBeRecordOf()
std::string recordFor(const SiteInput& input, const std::string& folder);
/// Returns the site with the ids of its record: of a storey in that of its building, movers and the
/// sensors on them have the storey before their ids. \throws as RunReader
SiteScene sceneForRecord(const SiteInput& input, const std::string& folder);

/// Prints the warnings and choices of importers, as warnOfImport() of a room.
void warnOfImport(const CommonOptions& options, const std::string& tool, const SiteInput& input);

/// Returns checkScene() of each room, and of buildings what stands around it, as warnings.
/// \param filter takes ids of the site: "ground/l1"
std::vector<Diagnostic> siteWarnings(const SiteInput& input, const FindingFilter& filter);

/// Reads a text about zones in the rooms of a site, in that of a room alone as it is: `STOREY/TEXT`
/// for each storey that the glob STOREY matches, `TEXT` for all. Calls read(room, text); rooms of
/// which it throws UsageError are left out, unless there is no other. \param option for messages
/// \throws UsageError for a storey that does not exist, for rectangles and polygons without a
/// storey, and the first error of `read` if all rooms are left out
void forEachRoomOf(const StoreyedDocument& site, std::string_view option, const std::string& text,
                   const std::function<void(std::size_t room, const std::string& text)>& read);
/// The same in the rooms of an input; of a storey that was chosen, its own id may come first.
void forEachRoomOf(const SiteInput& input, std::string_view option, const std::string& text,
                   const std::function<void(std::size_t room, const std::string& text)>& read);

/// Returns a text about a room that is a storey without the storey before it: of `ground/entry` and
/// of `g*/entry` `entry`, and so with the name of the storey. Other texts, and those about other
/// rooms, stay.
std::string inOwnStorey(const SiteInput& input, const std::string& text);
std::vector<std::string> inOwnStorey(const SiteInput& input, const std::vector<std::string>& texts);

/// \throws UsageError saying that an option needs one room, with the storeys to choose from;
/// accepts "" and a room alone
void mustBeOneRoom(const SiteInput& input, const std::string& option);

}  // namespace ispace
