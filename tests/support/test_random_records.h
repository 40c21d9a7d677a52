// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of readers and writers: random documents of any schemas.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "record/record.h"

namespace ispace {

/// Creates documents of valid values: numbers of all magnitudes, texts with all
/// characters that are special in some language. The records need not make sense together.
class RandomDocuments {
  public:
    RandomDocuments(const Schemas& schemas, std::uint64_t seed)
        : schemas_(&schemas), random_(seed) {}

    Document document() {
        Document document;
        document.kind = below(2) == 0 ? DocumentKind::Environment : DocumentKind::Layout;
        for (std::size_t n = below(3); n > 0; --n)
            document.history.push_back("tool " + std::to_string(n) + " 'x y' h\xc3\xb6he # ");
        const std::size_t count = below(8);
        for (std::size_t n = 0; n < count; ++n) document.records.push_back(record(n));
        return document;
    }

    /// \param number makes a written id unique
    Record record(std::size_t number) {
        const auto& all = schemas_->all();
        Record record(all[below(all.size())]);
        for (const KeySpec& key : record.schema().keys)
            if (key.required || below(2) == 0) record.set(key.name, value(key));
        if (record.has("id")) record.set("id", record.text("id") + std::to_string(number));
        return record;
    }

    Value value(const KeySpec& key) {
        switch (key.type) {
            case KeyType::Flag:
                return below(2) == 0;
            case KeyType::Number:
                return number(key);
            case KeyType::Text:
                return text();
            case KeyType::Word:
                return word();
            case KeyType::Choice:
                return key.choices[below(key.choices.size())];
            case KeyType::Tuple:
                return tuple(key);
            case KeyType::TupleList:
                break;
        }
        TupleList list(1 + below(5));
        for (Tuple& item : list) item = tuple(key);
        return list;
    }

  private:
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }

    double fraction() { return std::uniform_real_distribution<double>(0, 1)(random_); }

    double anyNumber() {
        const double sign = below(2) == 0 ? 1 : -1;
        switch (below(6)) {
            case 0:
                return sign * static_cast<double>(below(20));
            case 1:
                return sign * static_cast<double>(below(100000)) / 1000;
            case 2:
                return sign * std::pow(10, -308 + 616 * fraction());
            case 3:
                return sign * 4.9406564584124654e-324;
            default:
                return sign * std::pow(10, -9 + 26 * fraction());
        }
    }

    double number(const KeySpec& key) {
        if (key.default_value && std::holds_alternative<double>(*key.default_value) &&
            below(4) == 0)
            return std::get<double>(*key.default_value);
        for (int i = 0; i < 8; ++i) {
            const double x = key.whole ? std::floor(anyNumber()) : anyNumber();
            if (x <= key.upper && (key.lower_open ? x > key.lower : x >= key.lower)) return x;
        }
        const double low = std::max(key.lower, -1e6), high = std::min(key.upper, 1e6);
        const double x = high - (high - low) * fraction();
        return key.whole ? std::ceil(x) : x;
    }

    Tuple tuple(const KeySpec& key) {
        const std::size_t most = std::min(key.max_count, key.min_count + 4);
        Tuple tuple(key.min_count + below(most - key.min_count + 1));
        for (double& x : tuple) x = number(key);
        return tuple;
    }

    std::string word() {
        static const std::vector<std::string> words = {
            "w.-/+:@_", "yes",  "No",     "null", "1e5", "007",  "-",
            ".5",       "0x1F", "a:",     ":",    "nan", ".inf", "y",
            "12:30:45", "/a",   "a-b/c1", "@",    "+1",  "e5",   "sha256:0"};
        return words[below(words.size())];
    }

    std::string text() {
        static const std::vector<std::string> whole = {
            "",    "yes",  "null",    "~",   "12",    "1.5e3", "- a",      "a: b",   "{a}",   "[1]",
            "*a",  "&a",   "!!str x", "| ",  "> ",    "%YAML", "@a",       "`a`",    "---",   "...",
            "? a", "# a",  "a #b",    "'a'", "\"a\"", " a",    "a ",       "\\",     "\\x41", "=",
            "<<",  "true", "0o17",    "a,b", "\n",    "\t",    "\n\n a\n", "a\n  b", ": ",    "-"};
        if (below(3) == 0) return whole[below(whole.size())];
        static const std::vector<std::string> pieces = {"a",
                                                        "Z",
                                                        "0",
                                                        " ",
                                                        "  ",
                                                        "\"",
                                                        "\\",
                                                        "\\n",
                                                        "\n",
                                                        "\t",
                                                        "#",
                                                        "=",
                                                        ";",
                                                        ",",
                                                        "'",
                                                        ": ",
                                                        "- ",
                                                        "{",
                                                        "}",
                                                        "[",
                                                        "]",
                                                        "|",
                                                        ">",
                                                        "%",
                                                        "\xc3\xb6",
                                                        "\xc2\x85",
                                                        "\xc2\xa0",
                                                        "\xe2\x80\xa8",
                                                        "\xe2\x80\xa9",
                                                        "\xf0\x9f\x98\x80",
                                                        "\xef\xbb\xbf",
                                                        "\xef\xbf\xbe",
                                                        "\xef\xbf\xbd",
                                                        "\xf4\x8f\xbf\xbf",
                                                        "\xee\x80\x80",
                                                        "\xc2\x9b"};
        std::string text;
        for (std::size_t n = below(12); n > 0; --n) text += pieces[below(pieces.size())];
        return text;
    }

    const Schemas* schemas_;
    std::mt19937_64 random_;
};

}  // namespace ispace
