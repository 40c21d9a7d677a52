// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/glob.h"

#include <algorithm>
#include <bitset>
#include <cctype>
#include <optional>
#include <utility>

namespace ispace {

namespace {

constexpr std::size_t kBytes = 256;
constexpr std::size_t kBits = 64;  // of a word

/// Bytes that an element of a pattern matches.
using ByteSet = std::bitset<kBytes>;

std::size_t indexOf(char c) { return static_cast<unsigned char>(c); }

using Predicate = int (*)(int);
constexpr std::pair<std::string_view, Predicate> kClasses[] = {
    {"alnum", std::isalnum}, {"alpha", std::isalpha}, {"blank", std::isblank},
    {"cntrl", std::iscntrl}, {"digit", std::isdigit}, {"graph", std::isgraph},
    {"lower", std::islower}, {"print", std::isprint}, {"punct", std::ispunct},
    {"space", std::isspace}, {"upper", std::isupper}, {"xdigit", std::isxdigit}};

/// Parses a pattern from the left.
class GlobParser {
  public:
    explicit GlobParser(std::string_view rest) : rest_(rest) {}

    [[nodiscard]] bool atEnd() const { return rest_.empty(); }
    bool takeStar() {
        if (!rest_.starts_with('*')) return false;
        rest_.remove_prefix(1);
        return true;
    }
    /// \pre !atEnd(), no star
    ByteSet takeElement() {
        if (rest_.front() == '[') {
            if (const auto set = takeSet()) return *set;
        } else if (rest_.front() == '?') {
            rest_.remove_prefix(1);
            return ByteSet().set();
        }
        const bool is_escaped = rest_.front() == '\\';
        if (is_escaped) rest_.remove_prefix(1);
        // A backslash at the end has no meaning: the pattern matches only its own text.
        return rest_.empty() ? ByteSet() : ByteSet().set(indexOf(take()));
    }

  private:
    char take() {
        const char c = rest_.front();
        rest_.remove_prefix(1);
        return c;
    }
    /// Parses [...]; returns nullopt and consumes no bytes if the bracket is not closed.
    std::optional<ByteSet> takeSet() {
        const std::string_view before = rest_;
        rest_.remove_prefix(1);
        const bool is_negated = rest_.starts_with('!') || rest_.starts_with('^');
        if (is_negated) rest_.remove_prefix(1);
        ByteSet set;
        for (bool is_first = true; !rest_.empty(); is_first = false) {
            if (rest_.front() == ']' && !is_first) {
                rest_.remove_prefix(1);
                return is_negated ? ~set : set;
            }
            if (!takeClass(set)) takeRange(set);
        }
        rest_ = before;
        return std::nullopt;
    }
    /// Parses [:alpha:].
    bool takeClass(ByteSet& set) {
        if (!rest_.starts_with("[:")) return false;
        for (const auto& [name, has] : kClasses) {
            std::string_view behind = rest_.substr(2);
            if (!behind.starts_with(name) || !behind.substr(name.size()).starts_with(":]"))
                continue;
            for (std::size_t c = 0; c < kBytes; ++c)
                if (c < kBytes / 2 && has(static_cast<int>(c)) != 0) set.set(c);
            rest_.remove_prefix(name.size() + std::string_view("[::]").size());
            return true;
        }
        return false;
    }
    char takeEnd() {
        if (rest_.front() == '\\' && rest_.size() > 1) rest_.remove_prefix(1);
        return take();
    }
    void takeRange(ByteSet& set) {
        const std::size_t first = indexOf(takeEnd());
        std::size_t last = first;
        if (rest_.size() > 1 && rest_.front() == '-' && rest_[1] != ']') {
            rest_.remove_prefix(1);
            last = indexOf(takeEnd());
        }
        for (std::size_t c = first; c <= last; ++c) set.set(c);
    }

    std::string_view rest_;
};

void setBit(std::uint64_t* words, std::size_t bit) {
    words[bit / kBits] |= std::uint64_t{1} << (bit % kBits);
}

}  // namespace

Glob::Glob(std::string_view text) : text_(text) {
    if (text.find_first_of("*?[\\") == std::string_view::npos) return;
    words_ = text.size() / kBits + 1;
    accepts_.resize(kBytes * words_);
    loops_.resize(words_);
    for (GlobParser parser(text); !parser.atEnd();) {
        if (parser.takeStar()) {
            setBit(loops_.data(), elements_);
            continue;
        }
        const ByteSet set = parser.takeElement();
        for (std::size_t c = 0; c < kBytes; ++c)
            if (set[c]) setBit(&accepts_[c * words_], elements_);
        ++elements_;
    }
}

/// Updates all states at once, as Baeza-Yates and Gonnet (1992) and Wu and Manber (1992) do.
bool Glob::matches(std::string_view name) const {
    if (name == text_) return true;
    if (!isPattern()) return false;
    std::vector<std::uint64_t> states(words_);
    states[0] = 1;
    for (const char c : name) {
        const std::uint64_t* const accepts = &accepts_[indexOf(c) * words_];
        std::uint64_t carry = 0, any = 0;
        for (std::size_t k = 0; k < words_; ++k) {
            const std::uint64_t matched = states[k] & accepts[k];
            states[k] = (matched << 1) | carry | (states[k] & loops_[k]);
            carry = matched >> (kBits - 1);
            any |= states[k];
        }
        if (any == 0) return false;
    }
    return ((states[elements_ / kBits] >> (elements_ % kBits)) & 1) != 0;
}

}  // namespace ispace
