// SPDX-License-Identifier: GPL-3.0-or-later
// Common Data Representation, version 1, little-endian: the encoding of ROS 2's messages. Readers
// are for untrusted bytes: a count beyond the message is an error, and texts are views of it.
//
//     const std::string bytes = CdrWriter().put(std::uint32_t{7}).put("l1").take();
//     CdrReader in(bytes);
//     const auto number = in.number<std::uint32_t>();  // 7
//     const std::string_view name = in.text();  // "l1"
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "base/file.h"

namespace ispace {

/// Bytes before the data, which name the encoding. Alignment counts from their end.
inline constexpr std::string_view kCdrHead{"\0\1\0\0", 4};

/// Writes a message: numbers are aligned to multiples of their size.
class CdrWriter {
  public:
    CdrWriter() : out_(kCdrHead) {}

    template <typename Number>
    CdrWriter& put(Number value) {
        align(sizeof(Number));
        appendLittle(out_, value);
        return *this;
    }
    CdrWriter& put(bool value) { return put(static_cast<std::uint8_t>(value)); }
    CdrWriter& put(std::string_view text) {
        count(text.size() + 1);
        out_.append(text).append(1, '\0');
        return *this;
    }
    CdrWriter& put(const char* text) { return put(std::string_view(text)); }
    CdrWriter& put(const std::string& text) { return put(std::string_view(text)); }
    /// Writes a fixed number of values, known from the type.
    template <typename Number>
    CdrWriter& array(std::span<const Number> values) {
        align(sizeof(Number));
        out_.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
        return *this;
    }
    /// Writes a count and its values.
    template <typename Number>
    CdrWriter& sequence(std::span<const Number> values) {
        count(values.size());
        return values.empty() ? *this : array(values);
    }
    CdrWriter& bytes(std::string_view values) {
        count(values.size());
        out_ += values;
        return *this;
    }
    CdrWriter& count(std::size_t number) { return put(static_cast<std::uint32_t>(number)); }

    [[nodiscard]] std::string take() { return std::move(out_); }

  private:
    void align(std::size_t size) {
        out_.append((size - (out_.size() - kCdrHead.size()) % size) % size, '\0');
    }

    std::string out_;
};

/// Reads a message. Each function throws FormatError if the bytes end before the value does.
class CdrReader {
  public:
    /// \pre `bytes` outlive the reader. \throws FormatError for another encoding
    explicit CdrReader(std::string_view bytes) : bytes_(bytes) {
        // The last byte may count the padding at the end.
        if (bytes.size() < kCdrHead.size() || bytes.substr(0, 3) != kCdrHead.substr(0, 3))
            throw FormatError({"", 0, 0, "the message is no little-endian CDR, version 1"});
        at_ = kCdrHead.size();
    }

    template <typename Number>
    Number number() {
        static_assert(std::is_arithmetic_v<Number>);
        align(sizeof(Number));
        Number value{};
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    std::string_view text() {
        const std::string_view text = take(number<std::uint32_t>());
        return text.ends_with('\0') ? text.substr(0, text.size() - 1) : text;
    }
    /// Returns `count` values of this size each, without a copy.
    std::string_view values(std::size_t count, std::size_t size) {
        if (count == 0) return {};
        align(size);
        if (count > (bytes_.size() - at_) / size) refuse();
        return take(count * size);
    }
    /// Returns the number of elements of a sequence, each of which takes at least one byte.
    std::size_t count() {
        const std::size_t count = number<std::uint32_t>();
        if (count > bytes_.size() - at_) refuse();
        return count;
    }

  private:
    [[noreturn]] static void refuse() {
        throw FormatError({"", 0, 0, "the message ends before its last field"});
    }
    void align(std::size_t size) {
        const std::size_t padding = (size - (at_ - kCdrHead.size()) % size) % size;
        if (padding > bytes_.size() - at_) refuse();
        at_ += padding;
    }
    std::string_view take(std::size_t size) {
        if (size > bytes_.size() - at_) refuse();
        return bytes_.substr(std::exchange(at_, at_ + size), size);
    }

    std::string_view bytes_;
    std::size_t at_ = 0;
};

}  // namespace ispace
