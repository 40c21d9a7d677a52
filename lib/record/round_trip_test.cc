// SPDX-License-Identifier: GPL-3.0-or-later
// Random documents are written and read back.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "record/test_schemas.h"
#include "record/text.h"

namespace ispace {
namespace {

class RandomDocuments {
  public:
    explicit RandomDocuments(std::uint64_t seed) : random_(seed) {}

    Document document() {
        Document document;
        document.kind = below(2) == 0 ? DocumentKind::Environment : DocumentKind::Layout;
        for (std::size_t n = below(3); n > 0; --n)
            document.history.push_back("tool " + std::to_string(n) + " 'x y' h\xc3\xb6he # ");
        const auto& schemas = testSchemas().all();
        for (std::size_t n = below(8); n > 0; --n) {
            Record record(schemas[below(schemas.size())]);
            for (const KeySpec& key : record.schema().keys)
                if (key.required || below(2) == 0) record.set(key.name, value(key));
            if (record.has("id")) record.set("id", record.text("id") + std::to_string(n));
            document.records.push_back(record);
        }
        return document;
    }

  private:
    std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }

    double number(const KeySpec& key) {
        if (key.default_value && below(4) == 0) return std::get<double>(*key.default_value);
        std::uniform_real_distribution<double> exponent(-9, 17), part(0, 1);
        if (key.upper <= 360) return key.upper * (1 - part(random_));
        const double size = std::pow(10, exponent(random_));
        return key.lower >= 0 || below(2) == 0 ? size : -size;
    }

    Tuple tuple(const KeySpec& key) {
        Tuple tuple(key.min_count + below(key.max_count - key.min_count + 1));
        for (double& x : tuple) x = below(5) == 0 ? static_cast<double>(below(3)) : number(key);
        return tuple;
    }

    std::string text() {
        const std::vector<std::string> pieces = {"a",
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
                                                 "\xc3\xb6",
                                                 "\xf0\x9f\x98\x80",
                                                 "\xef\xbb\xbf"};
        std::string text;
        for (std::size_t n = below(12); n > 0; --n) text += pieces[below(pieces.size())];
        return text;
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
                return "w.-/+:@_" + std::to_string(below(1000)) + '-';
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

    std::mt19937_64 random_;
};

TEST(RoundTrip, DocumentsReadBackEqual) {
    RandomDocuments random(7);
    for (int i = 0; i < 3000; ++i) {
        const Document document = random.document();
        const std::string text = writeRecordText(document);
        const Document again = readRecordText(text, "a.env", testSchemas());
        EXPECT_EQ(again.kind, document.kind);
        EXPECT_EQ(again.history, document.history);
        ASSERT_EQ(again.records, document.records) << text;
        ASSERT_EQ(writeRecordText(again), text);
        for (const Record& record : document.records)
            EXPECT_EQ(readRecord(formatRecord(record), "x", testSchemas()), record);
    }
}

}  // namespace
}  // namespace ispace
