// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of the protocol as words, numbers and fields, in any locale. Functions here do not touch
// the connection.
//
//     const std::vector<std::string> ids = split("l1,l2", ',');  // "l1", "l2"
//     const double range = numberOf("-");                        // infinity: no return
#ifndef ISPACE_CLIENT_MESSAGE_H
#define ISPACE_CLIENT_MESSAGE_H

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <locale>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <ispace_client/error.h>

namespace ispace {
namespace client {

/// Parses a number, independent of the locale; "-" is infinity, which means no return. Short ones,
/// as in scans, cost no stream.
/// \throws ProtocolError for other texts, "inf" and "nan" among them
inline double numberOf(const std::string& text) {
    if (text == "-") return std::numeric_limits<double>::infinity();
    // Up to 15 digits, as the server writes measured values, one division rounds correctly.
    std::size_t i = text.size() > 1 && text[0] == '-' ? 1 : 0;
    std::int64_t digits = 0;
    double scale = 1;
    bool behind_point = false;
    std::size_t count = 0;
    for (; i < text.size(); ++i) {
        if (text[i] == '.' && !behind_point) {
            behind_point = true;
            continue;
        }
        if (text[i] < '0' || text[i] > '9' || ++count > 15) break;
        digits = digits * 10 + (text[i] - '0');
        if (behind_point) scale *= 10;
    }
    if (i == text.size() && count > 0)
        return (text[0] == '-' ? -1.0 : 1.0) * static_cast<double>(digits) / scale;
    std::istringstream in(text);
    in.imbue(std::locale::classic());
    double value = 0;
    if (!(in >> value) || in.peek() != std::istringstream::traits_type::eof())
        throw ProtocolError("the server sent `" + text + "` for a number");
    return value;
}

/// Parses a number of things, or an index. \throws ProtocolError for other texts
inline std::size_t countOf(const std::string& text) {
    const double value = numberOf(text);
    if (!(value >= 0 && value <= 1e9) || value != std::floor(value))
        throw ProtocolError("the server sent `" + text + "` for a count");
    return static_cast<std::size_t>(value);
}

/// Returns a text that converts back to the same double, independent of the locale: of at least six
/// digits the fewest that do. \throws Error for infinity and NaN, which no request takes
inline std::string textOf(double value) {
    if (!std::isfinite(value)) throw Error("a request has a number that is not finite");
    for (int digits = 6;; ++digits) {
        std::ostringstream out;
        out.imbue(std::locale::classic());
        out.precision(digits);
        out << value;
        std::istringstream in(out.str());
        in.imbue(std::locale::classic());
        double again = 0;
        if (digits >= 17 || ((in >> again) && again == value)) return out.str();
    }
}

/// Splits `text` at separators; empty for an empty text. Parts may be empty: "a,,b" has three.
inline std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin < text.size() || !parts.empty();) {
        const std::size_t end = text.find(separator, begin);
        parts.push_back(text.substr(begin, end == std::string::npos ? end : end - begin));
        if (end == std::string::npos) break;
        begin = end + 1;
    }
    return parts;
}

/// A pose in the room, metres and degrees. A heading is in (-180, 180], counter-clockwise, 0 along
/// x.
struct Pose {
    double x = 0, y = 0, heading = 0;
};

/// A pose in space. Tilt is positive upward.
struct Pose3 {
    double x = 0, y = 0, z = 0, heading = 0, tilt = 0, roll = 0;
};

/// The `key=value` pairs of a line, in its order. A look-up goes through them all; of a key that
/// comes twice it finds the first. Keys that a newer server adds are here as well.
class Fields {
  public:
    void add(const std::string& key, const std::string& value) {
        pairs_.push_back(std::make_pair(key, value));
    }
    bool has(const std::string& key) const { return find(key) != nullptr; }
    /// \throws ProtocolError if the key is missing, as do all functions below
    const std::string& text(const std::string& key) const {
        const std::string* const value = find(key);
        if (!value) throw ProtocolError("the server's answer has no `" + key + "`");
        return *value;
    }
    std::string text(const std::string& key, const std::string& otherwise) const {
        const std::string* const value = find(key);
        return value ? *value : otherwise;
    }
    double number(const std::string& key) const { return numberOf(text(key)); }
    /// \throws ProtocolError also for infinity and other numbers that no `long` can have
    long integer(const std::string& key) const {
        const double value = number(key);
        if (!(std::abs(value) < static_cast<double>(std::numeric_limits<long>::max())))
            throw ProtocolError("the server sent `" + key + '=' + text(key) + "` for an integer");
        return std::lround(value);
    }
    bool flag(const std::string& key) const { return text(key) == "1"; }
    /// Splits a value at commas.
    std::vector<std::string> list(const std::string& key) const { return split(text(key), ','); }
    std::vector<double> numbers(const std::string& key) const {
        std::vector<double> values;
        for (const std::string& part : list(key)) values.push_back(numberOf(part));
        return values;
    }
    const std::vector<std::pair<std::string, std::string>>& pairs() const { return pairs_; }

  private:
    const std::string* find(const std::string& key) const {
        for (const auto& pair : pairs_)
            if (pair.first == key) return &pair.second;
        return nullptr;
    }
    std::vector<std::pair<std::string, std::string>> pairs_;
};

/// A line of the server, and its bytes.
struct Message {
    std::string line;  ///< unchanged
    std::vector<std::string>
        words;  ///< words that are not pairs; the first is OK, ERR, SCAN, DONE, FAIL, EVENT
    Fields fields;
    std::string data;  ///< bytes after a line with `bytes=`, or decoded from its `base64=`

    std::string word(std::size_t i) const { return i < words.size() ? words[i] : std::string(); }
};

/// Decodes base64 (RFC 4648, section 4) up to the first `=`. \throws ProtocolError for other bytes
inline std::string fromBase64(const std::string& text) {
    std::string bytes;
    unsigned bits = 0;
    int count = 0;
    for (const char c : text) {
        int value = -1;
        if (c >= 'A' && c <= 'Z') value = c - 'A';
        if (c >= 'a' && c <= 'z') value = c - 'a' + 26;
        if (c >= '0' && c <= '9') value = c - '0' + 52;
        if (c == '+') value = 62;
        if (c == '/') value = 63;
        if (c == '=') break;
        if (value < 0) throw ProtocolError("the server's base64 has a `" + std::string(1, c) + "`");
        bits = bits << 6U | static_cast<unsigned>(value);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes += static_cast<char>(bits >> static_cast<unsigned>(count) & 0xFFU);
        }
    }
    return bytes;
}

/// Parses a line. `text=` and `what=`, in events, and `warning=` extend to the end of their line.
inline Message parseMessage(const std::string& line) {
    Message message;
    message.line = line;
    for (std::size_t begin = 0; begin < line.size();) {
        std::size_t end = line.find(' ', begin);
        if (line.compare(begin, 5, "text=") == 0 || line.compare(begin, 5, "what=") == 0 ||
            line.compare(begin, 8, "warning=") == 0)
            end = std::string::npos;
        const std::string word = line.substr(begin, end == std::string::npos ? end : end - begin);
        const std::size_t equal = word.find('=');
        if (equal == std::string::npos || message.words.empty()) {
            if (!word.empty()) message.words.push_back(word);
        } else {
            message.fields.add(word.substr(0, equal), word.substr(equal + 1));
        }
        if (end == std::string::npos) break;
        begin = end + 1;
    }
    return message;
}

}  // namespace client
}  // namespace ispace

#endif  // ISPACE_CLIENT_MESSAGE_H
