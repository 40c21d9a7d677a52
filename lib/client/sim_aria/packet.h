// SPDX-License-Identifier: GPL-3.0-or-later
// Layout: Pioneer 3 Operations Manual, packets of client and server. A packet grows as it is
// written; its length byte is that of finalizePacket(), modulo 256.
#ifndef SIM_ARIA_PACKET_H
#define SIM_ARIA_PACKET_H

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include <sim_aria/typedefs.h>
#include <sim_aria/util.h>

/// Bytes with a header and a footer, little-endian; reads continue where the last one ended. A read
/// beyond the data returns 0 and makes isValid() false.
class ArBasePacket {
  public:
    explicit ArBasePacket(ArTypes::UByte2 /*bufferSize*/ = 0, ArTypes::UByte2 headerLength = 0,
                          char* /*buf*/ = nullptr, ArTypes::UByte2 footerLength = 0)
        : myHeader(headerLength), myFooter(footerLength) {
        empty();
    }
    virtual ~ArBasePacket() {}

    virtual void empty() {
        myBytes.assign(myHeader, 0);
        resetRead();
    }
    virtual void finalizePacket() {}
    virtual void resetRead() {
        myRead = myHeader;
        myValid = true;
    }
    bool isValid() const { return myValid; }
    ArTypes::UByte2 getLength() const { return static_cast<ArTypes::UByte2>(myBytes.size()); }
    ArTypes::UByte2 getDataLength() const {
        return static_cast<ArTypes::UByte2>(myBytes.size() - std::min(myBytes.size(), myHeader));
    }
    ArTypes::UByte2 getReadLength() const { return static_cast<ArTypes::UByte2>(myRead); }
    ArTypes::UByte2 getDataReadLength() const {
        return static_cast<ArTypes::UByte2>(myRead - std::min(myRead, myHeader));
    }
    /// Cuts the packet, or fills it up with zeros.
    void setLength(ArTypes::UByte2 length) { myBytes.resize(length); }
    void setReadLength(ArTypes::UByte2 length) { myRead = length; }
    /// Whether so many bytes are left to read, before the footer.
    bool bufferContainsBytes(ArTypes::UByte2 count) const {
        return myRead + count + myFooter <= myBytes.size();
    }
    ArTypes::UByte2 getHeaderLength() const { return static_cast<ArTypes::UByte2>(myHeader); }
    ArTypes::UByte2 getFooterLength() const { return static_cast<ArTypes::UByte2>(myFooter); }
    const char* getBuf() const { return reinterpret_cast<const char*>(myBytes.data()); }

    void byteToBuf(ArTypes::Byte value) { put(static_cast<std::uint8_t>(value), 1); }
    void uByteToBuf(ArTypes::UByte value) { put(value, 1); }
    void byte2ToBuf(ArTypes::Byte2 value) { put(static_cast<std::uint16_t>(value), 2); }
    void uByte2ToBuf(ArTypes::UByte2 value) { put(value, 2); }
    void byte4ToBuf(ArTypes::Byte4 value) { put(static_cast<std::uint32_t>(value), 4); }
    void uByte4ToBuf(ArTypes::UByte4 value) { put(value, 4); }
    void strToBuf(const char* text) { dataToBuf(text, std::strlen(text) + 1); }
    void dataToBuf(const char* data, std::size_t length) {
        for (std::size_t i = 0; i < length; ++i) put(static_cast<std::uint8_t>(data[i]), 1);
    }

    ArTypes::Byte bufToByte() { return static_cast<ArTypes::Byte>(take(1)); }
    ArTypes::UByte bufToUByte() { return static_cast<ArTypes::UByte>(take(1)); }
    ArTypes::Byte2 bufToByte2() { return static_cast<ArTypes::Byte2>(take(2)); }
    ArTypes::UByte2 bufToUByte2() { return static_cast<ArTypes::UByte2>(take(2)); }
    ArTypes::Byte4 bufToByte4() { return static_cast<ArTypes::Byte4>(take(4)); }
    ArTypes::UByte4 bufToUByte4() { return take(4); }
    /// Reads up to the next 0.
    std::string bufToString() {
        std::string text;
        for (std::uint32_t c = take(1); c != 0 && myValid; c = take(1))
            text += static_cast<char>(c);
        return text;
    }
    /// The same into an array: always terminated.
    void bufToStr(char* buf, std::size_t length) {
        const std::string text = bufToString();
        if (length == 0) return;
        const std::size_t n = std::min(length - 1, text.size());
        std::memcpy(buf, text.data(), n);
        buf[n] = 0;
    }
    void bufToData(char* data, std::size_t length) {
        for (std::size_t i = 0; i < length; ++i) data[i] = static_cast<char>(take(1));
    }

    virtual void log() const {
        std::string text;
        char byte[8];
        for (const std::uint8_t value : myBytes) {
            std::snprintf(byte, sizeof byte, " %02x", static_cast<unsigned>(value));
            text += byte;
        }
        ArLog::log(ArLog::Terse, "packet of %u bytes:%s", static_cast<unsigned>(getLength()),
                   text.c_str());
    }

  protected:
    std::vector<std::uint8_t> myBytes;

  private:
    void put(std::uint32_t value, int bytes) {
        for (int i = 0; i < bytes; ++i)
            myBytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    }
    std::uint32_t take(std::size_t bytes) {
        std::uint32_t value = 0;
        if (myRead + bytes > myBytes.size()) {
            myValid = false;
            return 0;
        }
        for (std::size_t i = 0; i < bytes; ++i)
            value |= static_cast<std::uint32_t>(myBytes[myRead + i]) << (8 * i);
        myRead += bytes;
        return value;
    }

    std::size_t myHeader, myFooter;
    std::size_t myRead = 0;
    bool myValid = true;
};

/// A packet of a Pioneer: two bytes of synchronization, length, id, data, checksum.
class ArRobotPacket : public ArBasePacket {
  public:
    explicit ArRobotPacket(unsigned char sync1 = 0xfa, unsigned char sync2 = 0xfb)
        : ArBasePacket(0, 4, nullptr, 2) {
        myBytes[0] = sync1;
        myBytes[1] = sync2;
    }
    ArTypes::UByte getID() const { return myBytes[3]; }
    void setID(ArTypes::UByte id) { myBytes[3] = id; }
    ArTime getTimeReceived() const { return myTime; }
    void setTimeReceived(ArTime time) { myTime = time; }
    /// Writes length and checksum; call it after the last byte of data.
    void finalizePacket() override {
        myBytes[2] = static_cast<std::uint8_t>(myBytes.size() - 1);
        const unsigned int sum = calcCheckSum();
        myBytes.push_back(static_cast<std::uint8_t>(sum >> 8));
        myBytes.push_back(static_cast<std::uint8_t>(sum));
        resetRead();
    }
    bool verifyCheckSum() {
        if (myBytes.size() < 6) return false;
        const std::size_t n = myBytes.size();
        const unsigned int wanted = static_cast<unsigned int>(myBytes[n - 2] << 8 | myBytes[n - 1]);
        const std::vector<std::uint8_t> whole = myBytes;
        myBytes.resize(n - 2);
        const unsigned int sum = calcCheckSum();
        myBytes = whole;
        return sum == wanted;
    }
    /// Sum of big-endian words of id and data, an odd byte added by exclusive or.
    unsigned int calcCheckSum() const {
        unsigned int sum = 0;
        std::size_t i = 3;
        for (; i + 1 < myBytes.size(); i += 2)
            sum = (sum + static_cast<unsigned int>(myBytes[i] << 8 | myBytes[i + 1])) & 0xffffU;
        return i < myBytes.size() ? sum ^ myBytes[i] : sum;
    }

  private:
    ArTime myTime;
};

#endif  // SIM_ARIA_PACKET_H
