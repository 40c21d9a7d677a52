// SPDX-License-Identifier: GPL-3.0-or-later
// The scenes of a building, one for each storey, and reports and drawings of all of them.
//
// Ids are plain within a storey and begin with it across the building: "d1", "ground/d1". Layouts
// of buildings have the latter; rooms and scenes the former, so that code for rooms needs no
// storeys.
//
//     const SiteScene building = makeSiteScene(std::move(document), {}, devices);
//     const Scene& ground = *building.scenes.front();
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/file.h"
#include "drawing/drawing.h"
#include "scene/devices.h"
#include "scene/scene.h"
#include "site/storeys.h"

namespace ispace {

/// A building and the scene of each storey. Storeys of one room without a layout share a scene. A
/// room alone is one, too, with a storey without an id: see roomAlone().
struct SiteScene {
    StoreyedDocument document;
    std::vector<std::shared_ptr<const Scene>> scenes;  ///< by storey
    DeviceCatalogue devices = {};                      ///< of the scenes

    /// Returns the height of a storey: as given, else that of its highest wall.
    [[nodiscard]] double height(std::size_t storey) const;
    [[nodiscard]] bool isRoomAlone() const { return document.isRoomAlone(); }
};

/// Returns the building that a room alone is: its ids stand for themselves, and it is all that its
/// sensors see. \param room its environment \param scene of it
SiteScene roomAlone(Document room, std::shared_ptr<const Scene> scene,
                    const DeviceCatalogue& devices);

/// Converts a point of the building to the frame of a storey.
Point2 inStorey(const Storey& storey, Point2 p);

/// Returns the outline of a passage on a storey, in its frame. Of stairs: from the foot's right
/// corner to the head's, its left one, and that of the foot.
Polygon footprintOf(const StoreyPassage& passage, const Storey& storey);

/// Returns the id of a thing across the building: "ground/d1"; in a room alone "d1".
inline std::string wholeId(const Storey& storey, const std::string& id) {
    return storey.id.empty() ? id : storey.id + '/' + id;
}

/// Splits a layout by storey: ids become plain, and so do ids in references. `environment` and
/// `result` records are left out. Returns a document for each storey, empty for one without
/// records. \throws FormatError with all records whose ids begin with no storey
std::vector<Document> layoutsOf(const Document& layout, const StoreyedDocument& building);

/// Returns the record of a storey's room or layout as it stands in a layout of the building, with
/// the storey before its id and those that it refers to. \param id of the record, see assignIds()
Record inBuilding(const Storey& storey, Record record, const std::string& id);

/// Returns the scene of a storey with the ids of movers, and of the sensors on them, across the
/// building, as in the run of a building.
std::shared_ptr<const Scene> sceneWithWholeIds(const SiteScene& building, std::size_t storey);
/// The same for the scene of a storey that is read alone.
std::shared_ptr<const Scene> sceneWithWholeIds(const std::shared_ptr<const Scene>& scene,
                                               const Storey& home, const DeviceCatalogue& devices);

/// Builds the scenes. \param layouts by storey; empty: none \throws FormatError as makeScene()
SiteScene makeSiteScene(StoreyedDocument document, const std::vector<Document>& layouts,
                        const DeviceCatalogue& devices);

/// Checks the passages between storeys and the heights of these; checkScene() checks the rooms.
///
/// - stairs: a flight that begins or ends in a wall, in a solid or outside of the rooms;
/// - lifts: without a door, with one wider than the cabin, with a load that is no number of
///   kilograms, or that open in a wall or outside of the rooms;
/// - shafts: outlines with less than three corners or that cross themselves;
/// - storeys of one part of the building that overlap in height.
std::vector<Diagnostic> checkBuilding(const SiteScene& building);
/// Returns true if a person can step off the end of a flight, to any side: else checkBuilding()
/// reports it. \param end in the building \param back direction of the flight from there; empty:
/// unknown
bool hasPathOn(const SiteScene& building, std::size_t storey, Point2 end, std::optional<Vec2> back);

/// Returns one JSON object and a newline, schema ispace-info/1 with an item of `rooms` for each
/// storey; of a room alone infoJson() and infoText().
std::string siteInfoJson(const SiteScene& building);
std::string siteInfoText(const SiteScene& building);

/// Draws pictures of the storeys, the lowest at the bottom, in panels below each other.
/// \pre all have the unit of the page, and there is one
Picture panelsOf(const std::vector<Picture>& pictures);

/// Draws the plan of each storey in a panel. \param width of a PNG in pixels
std::string drawSite(const SiteScene& building, PictureFormat format, int width,
                     const std::string& title);

/// Writes a compiled building: glTF with a node for each storey, and the building as YAML in the
/// position of records.
void writeSiteGlb(const SiteScene& building, const ByteSink& sink);

}  // namespace ispace
