// SPDX-License-Identifier: GPL-3.0-or-later
// Text of STEP files (ISO 10303-21): strings, reals, lists, GUIDs in base 64 (22 digits, the first
// of which holds two bits). Times of the header are left out, so that equal models are equal bytes.
#include "extensions/ifc/ifc_write_model.h"

#include <cmath>
#include <cstdint>
#include <iterator>
#include <numbers>

#include "base/message.h"
#include "base/number.h"
#include "record/text.h"

namespace ispace::ifc {

namespace {

constexpr std::string_view kHexDigits = "0123456789ABCDEF";

void appendHex(std::string& out, std::uint32_t code, int digits) {
    for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4)
        out += kHexDigits[(code >> static_cast<unsigned>(shift)) & 15U];
}

/// The code point at `at`, which moves behind it.
std::uint32_t nextCodePoint(std::string_view text, std::size_t& at) {
    const auto lead = static_cast<unsigned char>(text[at++]);
    const int rest = lead < 0xC0 ? 0 : lead < 0xE0 ? 1 : lead < 0xF0 ? 2 : 3;
    std::uint32_t code = rest == 0 ? lead : lead & (0x3FU >> static_cast<unsigned>(rest));
    for (int i = 0; i < rest && at < text.size(); ++i)
        code = code << 6U | (static_cast<unsigned char>(text[at++]) & 0x3FU);
    return code;
}

std::string tupleOf(std::initializer_list<double> numbers) {
    std::string text = "(";
    for (const double number : numbers) {
        if (text.size() > 1) text += ',';
        text += stepReal(number);
    }
    return text + ')';
}

}  // namespace

std::string stepText(std::string_view text) {
    std::string out = "'";
    for (std::size_t at = 0; at < text.size();) {
        const std::uint32_t code = nextCodePoint(text, at);
        if (code >= 0x20 && code < 0x7F) {
            out.append(code == '\'' || code == '\\' ? 2 : 1, static_cast<char>(code));
            continue;
        }
        const bool is_wide = code > 0xFFFF;
        out += is_wide ? "\\X4\\" : "\\X2\\";
        appendHex(out, code, is_wide ? 8 : 4);
        out += "\\X0\\";
    }
    return out + '\'';
}

std::string stepReal(double value) {
    constexpr double kSteps = 1e12;
    std::string text = formatDouble(std::round(value * kSteps) / kSteps);
    const std::size_t exponent = text.find('e');
    if (text.find('.') == std::string::npos)
        text.insert(exponent == std::string::npos ? text.size() : exponent, 1, '.');
    if (exponent != std::string::npos) text[text.find('e')] = 'E';
    return text;
}

std::string stepList(std::span<const std::string> items) {
    std::string text = "(";
    for (const std::string& item : items) {
        if (text.size() > 1) text += ',';
        text += item;
    }
    return text + ')';
}

std::string ifcGuid(std::string_view seed) {
    constexpr std::string_view kDigits =
        "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$";
    constexpr int kBits = 128, kDigitBits = 6;
    const std::string hash = sha256(seed);
    const std::string_view hex = std::string_view(hash).substr(hash.find(':') + 1, kBits / 4);
    // 22 digits have 132 bits: the first digit holds only two.
    std::string guid;
    std::uint32_t bits = 0;
    int held = 22 * kDigitBits - kBits;
    for (const char c : hex) {
        bits = bits << 4U | static_cast<std::uint32_t>(c <= '9' ? c - '0' : c - 'a' + 10);
        held += 4;
        if (held < kDigitBits) continue;
        held -= kDigitBits;
        guid += kDigits[(bits >> static_cast<unsigned>(held)) & 63U];
        bits &= (1U << static_cast<unsigned>(held)) - 1;
    }
    return guid;
}

IfcModel::IfcModel(std::string seed) : seed_(std::move(seed)) {
    units_ = addUnits();
    up_ = addDirection({0, 0, 1});
    flat_ = add("IFCAXIS2PLACEMENT2D", {ref(addPoint({0, 0})), "$"});
    context_ = add("IFCGEOMETRICREPRESENTATIONCONTEXT",
                   {"$", "'Model'", "3", "1.E-05", ref(addAxes({})), "$"});
    body_ = add("IFCGEOMETRICREPRESENTATIONSUBCONTEXT",
                {"'Body'", "'Model'", "*", "*", "*", "*", ref(context_), "$", ".MODEL_VIEW.", "$"});
}

IfcModel::Id IfcModel::add(std::string_view type, std::span<const std::string> arguments) {
    data_ += ref(++last_) + '=';
    data_.append(type).append(stepList(arguments)) += ";\n";
    return last_;
}

IfcModel::Id IfcModel::addRooted(std::string_view type, std::string_view key, std::string_view name,
                                 std::initializer_list<std::string> others) {
    std::string seed = seed_ + '\n';
    seed.append(type).append("\n").append(key);
    std::vector<std::string> arguments{stepText(ifcGuid(seed)), "$",
                                       name.empty() ? "$" : stepText(name), "$"};
    arguments.insert(arguments.end(), others.begin(), others.end());
    return add(type, arguments);
}

IfcModel::Id IfcModel::addUnits() {
    std::vector<std::string> units;
    const auto si = [&](std::string type, std::string name) {
        return add("IFCSIUNIT", {"*", std::move(type), "$", std::move(name)});
    };
    for (const auto& [type, name] :
         {std::pair(".LENGTHUNIT.", ".METRE."), std::pair(".AREAUNIT.", ".SQUARE_METRE."),
          std::pair(".VOLUMEUNIT.", ".CUBIC_METRE."), std::pair(".FREQUENCYUNIT.", ".HERTZ.")})
        units.push_back(ref(si(type, name)));
    const Id radian = si(".PLANEANGLEUNIT.", ".RADIAN.");
    const Id no_dimensions = add("IFCDIMENSIONALEXPONENTS", {"0", "0", "0", "0", "0", "0", "0"});
    std::string degree = "IFCPLANEANGLEMEASURE(";
    degree += formatDouble(std::numbers::pi / 180) + ')';
    const Id measure = add("IFCMEASUREWITHUNIT", {degree, ref(radian)});
    units.push_back(ref(add("IFCCONVERSIONBASEDUNIT",
                            {ref(no_dimensions), ".PLANEANGLEUNIT.", "'DEGREE'", ref(measure)})));
    return add("IFCUNITASSIGNMENT", {stepList(units)});
}

IfcModel::Id IfcModel::addPoint(std::initializer_list<double> coordinates) {
    return add("IFCCARTESIANPOINT", {tupleOf(coordinates)});
}

IfcModel::Id IfcModel::addDirection(Vec3 direction) {
    return add("IFCDIRECTION", {tupleOf({direction.x, direction.y, direction.z})});
}

IfcModel::Id IfcModel::addAxes(const Pose3& pose) {
    const Frame3 frame(pose);
    const std::string point = ref(addPoint({pose.position.x, pose.position.y, pose.position.z}));
    if (pose.isLevel() && pose.heading == Angle())
        return add("IFCAXIS2PLACEMENT3D", {point, "$", "$"});
    const std::string up = ref(pose.isLevel() ? up_ : addDirection(frame.up));
    return add("IFCAXIS2PLACEMENT3D", {point, up, ref(addDirection(frame.forward))});
}

IfcModel::Id IfcModel::addPlacement(std::optional<Id> parent, const Pose3& pose) {
    return add("IFCLOCALPLACEMENT", {parent ? ref(*parent) : "$", ref(addAxes(pose))});
}

IfcModel::Id IfcModel::addOutline(const Polygon& outline) {
    std::vector<std::string> points;
    points.reserve(outline.size() + 1);
    for (const Point2 p : outline) points.push_back(ref(addPoint({p.x, p.y})));
    points.push_back(points.front());
    return add("IFCPOLYLINE", {stepList(points)});
}

IfcModel::Id IfcModel::addExtrusion(Id profile, const Pose3& pose, double height) {
    return add("IFCEXTRUDEDAREASOLID",
               {ref(profile), ref(addAxes(pose)), ref(up_), stepReal(height)});
}

IfcModel::Id IfcModel::addSolid(const SdfPart& part) {
    Pose3 foot{part.place, part.heading, {}, {}};
    if (part.shape == SdfPart::Shape::Polyline)
        return addExtrusion(
            add("IFCARBITRARYCLOSEDPROFILEDEF", {".AREA.", "$", ref(addOutline(part.outline))}),
            foot, part.height);
    foot.position.z -= part.height / 2;
    if (part.shape == SdfPart::Shape::Cylinder)
        return addExtrusion(
            add("IFCCIRCLEPROFILEDEF", {".AREA.", "$", ref(flat_), stepReal(part.radius)}), foot,
            part.height);
    return addExtrusion(
        add("IFCRECTANGLEPROFILEDEF",
            {".AREA.", "$", ref(flat_), stepReal(part.length), stepReal(part.width)}),
        foot, part.height);
}

IfcModel::Id IfcModel::addFaces(const Mesh& mesh) {
    std::vector<std::string> items;
    items.reserve(mesh.vertices.size());
    for (const Point3& p : mesh.vertices) items.push_back(tupleOf({p.x, p.y, p.z}));
    const Id points = add("IFCCARTESIANPOINTLIST3D", {stepList(items)});
    items.clear();
    for (const auto& corners : mesh.triangles) {
        std::string item = "(";
        for (const std::uint32_t corner : corners)
            item.append(item.size() > 1 ? "," : "").append(std::to_string(corner + 1));
        items.push_back(item + ')');
    }
    return add("IFCTRIANGULATEDFACESET",
               {ref(points), "$", isWatertight(mesh) ? ".T." : ".F.", stepList(items), "$"});
}

std::string IfcModel::addShape(std::string_view type, const std::vector<std::string>& items) {
    if (items.empty()) return "$";
    std::string quoted = stepText(type);
    const Id body =
        add("IFCSHAPEREPRESENTATION", {ref(body_), "'Body'", std::move(quoted), stepList(items)});
    return ref(add("IFCPRODUCTDEFINITIONSHAPE", {"$", "$", stepList({{ref(body)}})}));
}

std::string IfcModel::addShape(std::span<const SdfPart> parts, std::span<const Mesh> meshes) {
    std::vector<std::string> items;
    for (const Mesh& mesh : meshes)
        if (!mesh.triangles.empty()) items.push_back(ref(addFaces(mesh)));
    const bool has_faces = !items.empty();
    for (const SdfPart& part : parts)
        if (part.shape != SdfPart::Shape::Mesh) items.push_back(ref(addSolid(part)));
    return addShape(has_faces ? "Tessellation" : "SweptSolid", items);
}

std::string IfcModel::addShape(const Region& region, double height) {
    const std::string outline = ref(addOutline(region.outline));
    std::vector<std::string> holes;
    for (const Polygon& hole : region.holes) holes.push_back(ref(addOutline(hole)));
    const Id profile = holes.empty() ? add("IFCARBITRARYCLOSEDPROFILEDEF", {".AREA.", "$", outline})
                                     : add("IFCARBITRARYPROFILEDEFWITHVOIDS",
                                           {".AREA.", "$", outline, stepList(holes)});
    return addShape("SweptSolid", {ref(addExtrusion(profile, {}, height))});
}

void IfcModel::addProperties(Id object, std::string_view key, std::string_view set,
                             std::span<const IfcProperty> properties) {
    std::vector<std::string> items;
    for (const auto& [name, value] : properties)
        items.push_back(ref(add("IFCPROPERTYSINGLEVALUE", {stepText(name), "$", value, "$"})));
    const Id all = addRooted("IFCPROPERTYSET", key, set, {stepList(items)});
    addRooted("IFCRELDEFINESBYPROPERTIES", key, "", {stepList({{ref(object)}}), ref(all)});
}

void IfcModel::addQuantities(Id object, std::string_view key, std::string_view set,
                             std::initializer_list<IfcQuantity> quantities) {
    std::vector<std::string> items;
    for (const auto& [type, name, value] : quantities)
        items.push_back(ref(add("IFCQUANTITY" + std::string(type),
                                {stepText(name), "$", "$", stepReal(value), "$"})));
    const Id all = addRooted("IFCELEMENTQUANTITY", key, set, {"$", stepList(items)});
    addRooted("IFCRELDEFINESBYPROPERTIES", key, "", {stepList({{ref(object)}}), ref(all)});
}

std::string IfcModel::finish(std::string_view name) const {
    // The time is left out: equal scenes give equal bytes.
    std::string text =
        "ISO-10303-21;\nHEADER;\n"
        "FILE_DESCRIPTION(('ViewDefinition [DesignTransferView]'),'2;1');\nFILE_NAME(";
    text += stepText(name) + ",'',(''),(''),'ispace','ispace','');\n";
    text += "FILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n";
    return text + data_ + "ENDSEC;\nEND-ISO-10303-21;\n";
}

}  // namespace ispace::ifc
