// SPDX-License-Identifier: GPL-3.0-or-later
// XML of untrusted files, SDF and SVG, with lines for messages. O(bytes).
//
//     const XmlFile xml(bytes, "house.sdf");
//     if (!xml.root().child("world")) xml.fail(xml.root(), "no `world`");
#pragma once

#include <cstddef>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// A parsed XML file in UTF-8, with the line of each node. Neither entities nor other documents are
/// fetched, so no file can make it read another one (XXE) or grow (entity expansion). Not movable:
/// its nodes point into it.
class XmlFile {
  public:
    /// \param name for messages, as the user named it \throws FormatError with the line: bad XML
    XmlFile(std::string_view bytes, std::string name);
    XmlFile(const XmlFile&) = delete;
    XmlFile& operator=(const XmlFile&) = delete;

    [[nodiscard]] const std::string& name() const { return name_; }
    /// Returns the outermost element.
    [[nodiscard]] pugi::xml_node root() const { return document_.document_element(); }
    /// Returns the 1-based line of a node. O(log lines) \pre the node is of this file
    [[nodiscard]] int lineOf(pugi::xml_node node) const { return lineAt(node.offset_debug()); }
    /// \throws FormatError at the line of the node
    [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const;

  private:
    [[nodiscard]] int lineAt(std::ptrdiff_t offset) const;

    std::string name_;
    pugi::xml_document document_;
    std::vector<std::ptrdiff_t> line_ends_;
};

}  // namespace ispace
