// SPDX-License-Identifier: GPL-3.0-or-later
// SCIP 2.0 as bytes: numbers, check characters, lines, requests. Source: Hokuyo Automatic,
// "Communication Protocol Specification for SCIP 2.0 Standard", C-42-03320.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ispace {

/// The check character of a line's content.
char scipCheck(std::string_view content);

/// Appends the low 6 * characters bits of the value, six in each character, the greatest first.
void appendScipNumber(std::string& out, std::uint32_t value, int characters);

/// Appends a line with its check character: "00P\n". Of "KEY:value" lines a semicolon stands
/// between them that the check leaves out.
void appendScipLine(std::string& out, std::string_view content);
void appendScipField(std::string& out, std::string_view key, std::string_view value);
/// Appends encoded values in lines of 64 characters, each with its check character.
void appendScipData(std::string& out, std::string_view values);

/// Takes requests out of a stream of bytes. A request ends with LF, CR or both; empty ones are
/// left out.
class ScipLines {
  public:
    /// The longest request that is one; of a longer one only so much is kept.
    static constexpr std::size_t kLongest = 64;

    void append(std::string_view bytes) { bytes_ += bytes; }
    /// The next request, without its end; nothing until more bytes come.
    std::optional<std::string> next();
    /// Bytes kept.
    [[nodiscard]] std::size_t size() const { return line_.size() + bytes_.size(); }

  private:
    std::string line_;   // up to kLongest + 1 bytes of the one that has not ended
    std::string bytes_;  // not looked at yet
};

/// A request in its parts: "MD", "0044072501000", ";text" with its semicolon.
struct ScipRequest {
    std::string_view command, parameters, text;
    /// "0G" or "0H" if the text is none, "0F" if all is too long; else "".
    std::string_view fault;

    /// The commands of two letters, "SCIP2.0" and "%SL". \pre the line outlives it
    static ScipRequest of(std::string_view line);
};

/// What MD, MS, ME, GD, GS and GE ask for.
struct ScipSweep {
    int start = 0, end = 0, cluster = 1;
    int interval = 0;  ///< scans left out between two
    int count = 0;     ///< scans; 0: until told otherwise
};

/// Reads the parameters of a sweep; of GD and its kin there is neither interval nor count.
/// \param last greatest step \param status "00", or what is wrong with them
ScipSweep parseScipSweep(std::string_view parameters, bool streams, int last, std::string& status);

}  // namespace ispace
