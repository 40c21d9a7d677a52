// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers and lists as bytes, for results that another process or a later run reads: parts of
// shards, caches of batches. Not a file format: it carries neither version nor types, so the header
// of a part (part_head.h) must say which program wrote it. Little-endian. Sizes are checked before
// memory is allocated, so bytes of any origin cost no more than their own size.
//
//     Packer packer;
//     packer.add(runs.size());
//     packer.addAll(counts);                       // std::vector<std::uint32_t>
//     Unpacker unpacker(packer.bytes());
//     const std::uint64_t number = unpacker.number();
//     const auto again = unpacker.all<std::uint32_t>();
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/error.h"

namespace ispace {

static_assert(std::endian::native == std::endian::little, "packed numbers are little-endian");

/// Converts numbers and lists of numbers to bytes that another process reads.
class Packer {
  public:
    /// Appends eight bytes.
    void add(std::uint64_t number) { append(&number, sizeof number); }
    /// Appends the number of values and their bytes. Types have neither padding nor floats: equal
    /// lists give equal bytes.
    template <typename T>
    void addAll(const std::vector<T>& values) {
        static_assert(std::is_trivially_copyable_v<T> &&
                      std::has_unique_object_representations_v<T>);
        add(values.size());
        append(values.data(), values.size() * sizeof(T));
    }
    /// Appends the size of a text and its bytes.
    void addText(std::string_view text) {
        add(text.size());
        addBytes(text);
    }
    /// Appends the bytes of another Packer.
    void addBytes(std::string_view bytes) { append(bytes.data(), bytes.size()); }
    [[nodiscard]] const std::string& bytes() const { return bytes_; }

  private:
    void append(const void* from, std::size_t size) {
        if (size == 0) return;
        const std::size_t at = bytes_.size();
        bytes_.resize(at + size);
        std::memcpy(bytes_.data() + at, from, size);
    }
    std::string bytes_;
};

/// Packed bytes are not those of their writer; the reader knows no file.
class PackedError : public FormatError {
  public:
    PackedError() : FormatError({"", 0, 0, "the part of an earlier run is incomplete"}) {}
};

/// Reads the bytes of a Packer. \throws PackedError if there are too few bytes
class Unpacker {
  public:
    /// \pre `bytes` outlive the reader
    explicit Unpacker(std::string_view bytes) : rest_(bytes) {}

    /// Reads a number that add() wrote.
    std::uint64_t number() {
        std::uint64_t number = 0;
        take(&number, 1, sizeof number);
        return number;
    }
    /// Reads a list that addAll() wrote. Allocates no more than the bytes that remain.
    template <typename T>
    std::vector<T> all() {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::uint64_t count = number();
        if (count > rest_.size() / sizeof(T)) refuse();
        std::vector<T> values(count);
        take(values.data(), count, sizeof(T));
        return values;
    }
    /// Reads a text that addText() wrote.
    std::string text() {
        const std::vector<char> all_of_it = all<char>();
        return {all_of_it.begin(), all_of_it.end()};
    }
    /// True once all bytes were read: a reader checks it last.
    [[nodiscard]] bool atEnd() const { return rest_.empty(); }
    /// For values that the writer never stores.
    [[noreturn]] static void refuse() { throw PackedError(); }

  private:
    void take(void* to, std::size_t count, std::size_t size) {
        if (count * size > rest_.size()) refuse();
        if (count > 0) std::memcpy(to, rest_.data(), count * size);
        rest_.remove_prefix(count * size);
    }
    std::string_view rest_;
};

}  // namespace ispace
