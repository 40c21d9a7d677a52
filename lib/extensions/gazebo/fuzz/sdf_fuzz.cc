// SPDX-License-Identifier: GPL-3.0-or-later
// Worlds of Gazebo, in a folder with models to include: one that includes another, and two that
// include each other.
#include "fuzz.h"

#include <filesystem>

#include "extensions/gazebo/gazebo.h"
#include "scene/placement_schemas.h"

namespace {

using ispace::fuzz::scratchFolder;

void putModel(const std::string& name, const std::string& content) {
    const std::string folder = scratchFolder() + '/' + name;
    std::filesystem::create_directory(folder);
    ispace::fuzz::writeFile(folder + "/model.sdf", "<sdf version='1.9'><model name='" + name +
                                                       "'>" + content + "</model></sdf>");
}

const std::string& operand() {
    static const std::string name = [] {
        putModel(
            "box",
            "<pose>1 1 0 0 0 0</pose><link name='l'><collision name='c'><geometry><box><size>1 "
            "0.5 1</size></box></geometry></collision></link>"
            "<frame name='f' attached_to='l'><pose>0.5 0 0 0 0 1.5708</pose></frame>");
        putModel("two",
                 "<include><uri>model://box</uri></include><include merge='1'><uri>../box</uri>"
                 "<pose relative_to='box::f'>1 0 0 0 0 0</pose></include>");
        putModel("a", "<include><uri>model://b</uri></include>");
        putModel("b", "<include><uri>model://a</uri></include>");
        ispace::fuzz::writeFile(
            scratchFolder() + "/box/model.config",
            "<model><sdf version='1.9'>model.sdf</sdf><sdf version='1.6'>x.sdf</sdf></model>");
        return scratchFolder() + "/w.sdf";
    }();
    return name;
}

}  // namespace

void ispace::fuzz::tryInput(std::string_view bytes) {
    ImportOptions options;
    options.max_work.max = 2000;
    const Document document = gazebo::readSdf(bytes, operand(), options, sceneSchemas());
    checkText(document);
    tryScene(document, bytes);
}
