// SPDX-License-Identifier: GPL-3.0-or-later
// Packets of Pioneer robots (P2OS, ARCOS), in both directions: FA FB, a length, an id, data and a
// checksum. Numbers are little-endian. Published in the operations manuals of these robots; the
// clients that were looked at are ARIA (AriaCoda) and the p2os driver of Player.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ispace {

/// A packet without its frame.
struct P2osPacket {
    std::uint8_t id = 0;
    std::string data;
    friend bool operator==(const P2osPacket&, const P2osPacket&) = default;
};

/// Bytes of a packet's data at most: clients drop what is longer than 200 in all.
constexpr std::size_t kMaxP2osData = 194;

/// The checksum of id and data: the sum of their big-endian words, and a last single byte xor-ed
/// into it.
std::uint16_t p2osChecksum(std::string_view body);
/// The packet in its frame. \pre at most kMaxP2osData bytes of data
std::string p2osBytes(std::uint8_t id, std::string_view data = {});

/// Finds packets in a stream of bytes, however it is cut. What is no packet, or has a wrong
/// checksum, is passed over up to the next FA FB.
class P2osParser {
  public:
    void append(std::string_view bytes);
    /// The next whole packet; nothing if more bytes are needed. Call it until it gives nothing.
    std::optional<P2osPacket> take();
    /// Bytes that wait for the rest of their packet.
    [[nodiscard]] std::size_t pending() const { return bytes_.size(); }
    /// Gives up a packet that began but does not go on: its bytes may hold others.
    void skip();

  private:
    void drop(std::size_t count) { bytes_.erase(0, count); }

    std::string bytes_;  // begins with FA, or is empty, after take()
};

/// Data of a packet to be sent, field by field.
class P2osWriter {
  public:
    P2osWriter& u8(std::int64_t value) { return number(value, 1); }
    P2osWriter& u16(std::int64_t value) { return number(value, 2); }
    P2osWriter& u32(std::int64_t value) { return number(value, 4); }
    /// With its NUL.
    P2osWriter& text(std::string_view text) {
        data_.append(text).push_back('\0');
        return *this;
    }
    [[nodiscard]] std::size_t size() const { return data_.size(); }
    [[nodiscard]] std::string packet(std::uint8_t id) const { return p2osBytes(id, data_); }

  private:
    /// The low bytes of a number, so that negative ones are in two's complement.
    P2osWriter& number(std::int64_t value, int bytes);

    std::string data_;
};

/// The number a command carries: a type byte (3B, or 1B for one below 0) and two bytes of
/// magnitude; nothing if they are not all there.
std::optional<int> p2osNumber(const P2osPacket& command);
/// A little-endian number of two's complement within data. \pre the bytes are there
std::int32_t p2osInteger(std::string_view data, std::size_t at, std::size_t bytes);

}  // namespace ispace
