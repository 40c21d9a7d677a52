// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/cover only.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace ispace {

/// Reads one line of JSON (RFC 8259) from its beginning on, piece by piece, in the order in which
/// it is written. Strict: nothing that JSON does not know is passed over.
///
///     line.object([&](const std::string& key) { key == "value" ? use(line.number()) : line.skip();
///     }); line.end();
class JsonLine {
  public:
    /// \param number of the line, 1-based
    JsonLine(std::string_view text, std::string file, int number)
        : text_(text), file_(std::move(file)), number_(number) {}

    /// Calls visit(key) for each member, which has to read its value.
    template <typename Visit>
    void object(Visit visit);
    /// Calls visit() for each value, which has to read it.
    template <typename Visit>
    void array(Visit visit);
    std::string string();
    /// A finite one.
    double number();
    bool boolean();
    /// Any value. \throws FormatError for what is nested deeper than any sensible file
    void skip();
    /// \throws FormatError if anything but blanks follows
    void end();

    /// What is wrong with what was read last.
    [[noreturn]] void fail(std::string message) const;

  private:
    /// The next character that is no blank, '\0' at the end; it is not taken.
    char peek();
    /// Takes `wanted` if it comes next.
    bool takes(char wanted);
    void expect(char wanted, const char* name);
    bool takesWord(std::string_view word);
    void addEscape(std::string& text);
    unsigned hexDigits();

    std::string_view text_;
    std::string file_;
    int number_;
    std::size_t at_ = 0;     // next byte
    std::size_t begin_ = 0;  // of what was read last
    int depth_ = 0;
};

template <typename Visit>
void JsonLine::object(Visit visit) {
    expect('{', "an object");
    if (takes('}')) return;
    do {
        const std::string key = string();
        const std::size_t key_begin = begin_;
        expect(':', "a colon");
        begin_ = key_begin;
        visit(key);
    } while (takes(','));
    expect('}', "a comma or }");
}

template <typename Visit>
void JsonLine::array(Visit visit) {
    expect('[', "a list");
    if (takes(']')) return;
    do visit();
    while (takes(','));
    expect(']', "a comma or ]");
}

}  // namespace ispace
