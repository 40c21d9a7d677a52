// SPDX-License-Identifier: GPL-3.0-or-later
// Walks a message in CDR by its definition and writes JSON or CBOR; and back. Messages of clients
// are untrusted: a message that ends early, or a value that does not fit, is a FormatError with the
// field's name. Integers up to 2^53 pass JSON exactly.
#include "extensions/ros/ros_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/number.h"
#include "sense/formats/cdr.h"

namespace ispace::ros {

namespace {

using nlohmann::json;
using Kind = RosField::Kind;

/// Calls visit(value of a number's type) for a kind of numbers or bools.
template <typename Visit>
void withNumber(Kind kind, Visit visit) {
    if (kind == Kind::Bool) visit(bool());
    if (kind == Kind::Int8) visit(std::int8_t());
    if (kind == Kind::Uint8) visit(std::uint8_t());
    if (kind == Kind::Int32) visit(std::int32_t());
    if (kind == Kind::Uint32) visit(std::uint32_t());
    if (kind == Kind::Uint64) visit(std::uint64_t());
    if (kind == Kind::Float32) visit(float());
    if (kind == Kind::Float64) visit(double());
}

/// Reads one number; a bool is a byte.
template <typename Number>
Number numberFrom(CdrReader& in) {
    if constexpr (std::is_same_v<Number, bool>)
        return in.number<std::uint8_t>() != 0;
    else
        return in.number<Number>();
}

/// Walks through a message by its definition and hands its parts to a writer.
template <typename Writer>
class Walk {
  public:
    Walk(std::string_view message, Writer& out) : in_(message), out_(&out) {}

    void structure(const RosStruct& type) {
        out_->beginStruct(type.fields.size());
        for (const RosField& field : type.fields) {
            out_->name(field.name);
            field.is_array ? list(field) : one(field);
        }
        out_->endStruct();
    }

  private:
    void one(const RosField& field) {
        if (field.kind == Kind::Struct) return structure(*field.fields);
        if (field.kind == Kind::Text) return out_->text(in_.text());
        withNumber(field.kind,
                   [&](auto number) { out_->number(numberFrom<decltype(number)>(in_)); });
    }
    void list(const RosField& field) {
        const std::size_t count = field.length > 0 ? field.length : in_.count();
        const std::size_t size = sizeOf(field.kind);
        if (size > 0) return out_->numbers(field.kind, in_.values(count, size), count);
        out_->beginList(count);
        for (std::size_t i = 0; i < count; ++i) one(field);
        out_->endList();
    }

    CdrReader in_;
    Writer* out_;
};

class JsonOutput {
  public:
    void beginStruct(std::size_t /*fields*/) { json_.beginObject(); }
    void endStruct() { json_.endObject(); }
    void name(std::string_view name) { json_.key(name); }
    void beginList(std::size_t /*count*/) { json_.beginArray(); }
    void endList() { json_.endArray(); }
    void text(std::string_view text) { json_.value(text); }
    template <typename Number>
    void number(Number value) {
        if constexpr (std::is_integral_v<Number> && !std::is_same_v<Number, bool>)
            json_.value(static_cast<std::int64_t>(value));
        else
            json_.value(value);
    }
    void numbers(Kind kind, std::string_view bytes, std::size_t count) {
        if (kind == Kind::Uint8 || kind == Kind::Bool) return text(base64(bytes));
        json_.beginArray();
        withNumber(kind, [&](auto value) {
            for (std::size_t i = 0; i < count; ++i) {
                std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
                number(value);
            }
        });
        json_.endArray();
    }
    std::string take() { return json_.take(); }

  private:
    JsonWriter json_;
};

/// Appends the bytes of a number, most significant first.
template <typename Number>
void appendBig(std::string& out, Number number) {
    std::string bytes(sizeof number, '\0');
    std::memcpy(bytes.data(), &number, sizeof number);
    out.append(bytes.rbegin(), bytes.rend());
}

class CborOutput {
  public:
    void beginStruct(std::size_t fields) { appendCborHead(out_, CborHead::Map, fields); }
    void endStruct() {}
    void name(std::string_view name) { text(name); }
    void beginList(std::size_t count) { appendCborHead(out_, CborHead::List, count); }
    void endList() {}
    void text(std::string_view text) { appendCborText(out_, text); }
    template <typename Number>
    void number(Number value) {
        constexpr char kFalse = '\xf4', kTrue = '\xf5', kFloat = '\xfa', kDouble = '\xfb';
        if constexpr (std::is_same_v<Number, bool>) {
            out_ += value ? kTrue : kFalse;
        } else if constexpr (std::is_floating_point_v<Number>) {
            out_ += sizeof(Number) == sizeof(float) ? kFloat : kDouble;
            appendBig(out_, value);
        } else if (std::cmp_less(value, 0)) {
            appendCborHead(out_, CborHead::Negative,
                           ~static_cast<std::uint64_t>(value));  // -1 - value
        } else {
            appendCborHead(out_, CborHead::Unsigned, static_cast<std::uint64_t>(value));
        }
    }
    void numbers(Kind kind, std::string_view bytes, std::size_t /*count*/) {
        // Of RFC 8746, little-endian. Bytes need no tag.
        constexpr std::uint64_t kInt8 = 72, kInt32 = 78, kUint32 = 70, kFloat32 = 85, kFloat64 = 86;
        const std::uint64_t tag = kind == Kind::Int8      ? kInt8
                                  : kind == Kind::Int32   ? kInt32
                                  : kind == Kind::Uint32  ? kUint32
                                  : kind == Kind::Float32 ? kFloat32
                                  : kind == Kind::Float64 ? kFloat64
                                                          : 0;
        if (tag > 0) appendCborHead(out_, CborHead::Tag, tag);
        appendCborHead(out_, CborHead::Bytes, bytes.size());
        out_ += bytes;
    }
    std::string take() { return std::move(out_); }

  private:
    std::string out_;
};

template <typename Output>
std::string converted(RosType type, std::string_view message) {
    Output out;
    Walk<Output>(message, out).structure(rosFields(type));
    return out.take();
}

}  // namespace

void appendCborHead(std::string& out, CborHead head, std::uint64_t value) {
    constexpr unsigned kShift = 5, kShort = 24;
    const unsigned kind = static_cast<unsigned>(head) << kShift;
    const auto put = [&](unsigned low) { out += static_cast<char>(kind | low); };
    if (value < kShort) return put(static_cast<unsigned>(value));
    if (value <= std::numeric_limits<std::uint8_t>::max()) {
        put(kShort);
        appendBig(out, static_cast<std::uint8_t>(value));
    } else if (value <= std::numeric_limits<std::uint16_t>::max()) {
        put(kShort + 1);
        appendBig(out, static_cast<std::uint16_t>(value));
    } else if (value <= std::numeric_limits<std::uint32_t>::max()) {
        put(kShort + 2);
        appendBig(out, static_cast<std::uint32_t>(value));
    } else {
        put(kShort + 3);
        appendBig(out, value);
    }
}

void appendCborText(std::string& out, std::string_view text) {
    appendCborHead(out, CborHead::Text, text.size());
    out += text;
}

std::string rosJson(RosType type, std::string_view message) {
    return converted<JsonOutput>(type, message);
}

std::string rosCbor(RosType type, std::string_view message) {
    return converted<CborOutput>(type, message);
}

namespace {

/// Returns how deep the objects and lists of a JSON text nest at most.
int depthOf(std::string_view text) {
    int depth = 0, deepest = 0;
    bool is_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"') is_string = !is_string;
        if (is_string) {
            if (c == '\\') ++i;
            continue;
        }
        if (c == '{' || c == '[') deepest = std::max(deepest, ++depth);
        if (c == '}' || c == ']') --depth;
    }
    return deepest;
}

}  // namespace

// Counted ahead: the library's parser with a callback looks through a list after each of its items.
std::optional<json> parseClientJson(std::string_view text) {
    constexpr int kMaxDepth = 32;
    if (depthOf(text) > kMaxDepth) return std::nullopt;
    json value = json::parse(text.begin(), text.end(), nullptr, false);
    if (value.is_discarded()) return std::nullopt;
    return value;
}

namespace {

/// Writes a message by its definition, with the values of JSON.
class FromJson {
  public:
    void structure(const RosStruct& type, const json& value) {
        if (!value.is_null() && !value.is_object()) refuse(type.name, "an object");
        const bool is_time = type.name.starts_with("builtin_interfaces/");
        std::size_t read = 0;
        for (const RosField& field : type.fields) {
            const json& member = memberOf(value, field.name, is_time);
            read += member.is_discarded() ? 0 : 1;
            field.is_array ? list(field, member) : one(field, member);
        }
        if (value.is_object() && value.size() > read) refuseOthers(type, value, is_time);
    }
    std::string take() { return out_.take(); }

  private:
    [[noreturn]] static void refuse(const std::string& name, const std::string& wanted) {
        throw FormatError({"", 0, 0, excerpt(name) + " is wanted as " + wanted});
    }
    /// Accepts the counter that headers of ROS 1 have, and older names of the parts of a time.
    static void refuseOthers(const RosStruct& type, const json& value, bool is_time) {
        for (const auto& member : value.items()) {
            const std::string& name = member.key();
            const bool is_known = std::ranges::any_of(
                type.fields, [&](const RosField& field) { return field.name == name; });
            const bool is_old = is_time ? std::ranges::find(kOldTimes, name) != kOldTimes.end()
                                        : name == "seq" && type.name == "std_msgs/Header";
            if (!is_known && !is_old)
                throw FormatError({"", 0, 0, type.name + " has no member " + excerpt(name)});
        }
    }
    static const json& memberOf(const json& value, const std::string& name, bool is_time) {
        static const json none = json::value_t::discarded;
        if (!value.is_object()) return none;
        const auto found = value.find(name);
        if (found != value.end()) return *found;
        if (!is_time) return none;
        for (const std::string_view old : kOldTimes) {
            const auto there = value.find(old);
            if (there != value.end() && old.starts_with('s') == name.starts_with('s'))
                return *there;
        }
        return none;
    }
    void one(const RosField& field, const json& value) {
        static const json null;
        if (field.kind == Kind::Struct)
            return structure(*field.fields, value.is_discarded() ? null : value);
        if (field.kind == Kind::Text) {
            if (value.is_discarded()) return static_cast<void>(out_.put(""));
            if (!value.is_string()) refuse(field.name, "a text");
            return static_cast<void>(out_.put(value.get_ref<const std::string&>()));
        }
        withNumber(field.kind, [&](auto number) { put<decltype(number)>(field, value); });
    }
    template <typename Number>
    void put(const RosField& field, const json& value) {
        if (value.is_discarded()) {
            const double fallback = parseDouble(field.text_default).value_or(0);
            out_.put(static_cast<Number>(fallback));
            return;
        }
        if constexpr (std::is_same_v<Number, bool>) {
            if (!value.is_boolean()) refuse(field.name, "true or false");
            out_.put(value.get<bool>());
        } else if constexpr (std::is_floating_point_v<Number>) {
            if (!value.is_null() && !value.is_number()) refuse(field.name, "a number");
            out_.put(value.is_null() ? std::numeric_limits<Number>::quiet_NaN()
                                     : static_cast<Number>(value.get<double>()));
        } else {
            // Doubles have all whole numbers up to 2^53.
            constexpr double kMost = 9007199254740992.0;
            const auto least = static_cast<double>(std::numeric_limits<Number>::min()),
                       most =
                           std::min(static_cast<double>(std::numeric_limits<Number>::max()), kMost);
            const double number = value.is_number() ? value.get<double>() : least - 1;
            if (!(number >= least && number <= most) || number != std::floor(number))
                refuse(field.name, "a whole number of its type");
            out_.put(static_cast<Number>(number));
        }
    }
    void list(const RosField& field, const json& value) {
        static const json none = json::value_t::discarded;
        if (!value.is_discarded() && !value.is_array()) refuse(field.name, "a list");
        const std::size_t given = value.is_array() ? value.size() : 0;
        const std::size_t count = field.length > 0 ? field.length : given;
        if (given > 0 && given != count) refuse(field.name, std::to_string(count) + " values");
        if (field.length == 0) out_.count(count);
        for (std::size_t i = 0; i < count; ++i) one(field, given > 0 ? value[i] : none);
    }

    /// Parts of a time, as ROS 1 and Foxglove call them.
    static constexpr std::array<std::string_view, 3> kOldTimes{"secs", "nsecs", "nsec"};

    CdrWriter out_;
};

}  // namespace

std::string rosMessage(RosType type, const json& value) {
    FromJson out;
    out.structure(rosFields(type), value);
    return out.take();
}

}  // namespace ispace::ros
