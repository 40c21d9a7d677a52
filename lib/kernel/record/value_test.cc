// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>
#include <stdexcept>

#include "record/schema.h"
#include "support/test_schemas.h"

namespace {

/// Set: operator new fails.
bool is_memory_out = false;

}  // namespace

[[gnu::noinline]] void* operator new(std::size_t size) {
    void* const memory = is_memory_out ? nullptr : std::malloc(size);
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t /*size*/) noexcept {
    std::free(memory);
}

namespace ispace {
namespace value_test {

const KeySpec& keyOf(const char* keyword, const char* name) {
    return *testSchemas().find(keyword)->find(name);
}

/// The message about a value of a key, without "error: `key`: "; "" if it is accepted.
std::string refusal(const KeySpec& key, std::string_view text) {
    const auto findings = findingsOf([&] { (void)parseValue(key, text); });
    if (findings.empty()) return "";
    const std::string start = "error: `" + key.name + "`: ";
    EXPECT_EQ(findings.size(), 1U);
    EXPECT_TRUE(findings[0].starts_with(start)) << findings[0];
    return findings[0].substr(start.size());
}

double number(const KeySpec& key, std::string_view text) {
    return std::get<double>(parseValue(key, text));
}

TEST(Value, CanFailToBeCopied) {
    const Value text(std::string(100, 'x')), tuple(Tuple{1, 2}), list(TupleList{{1}, {2}});
    for (const Value* value : {&text, &tuple, &list}) {
        bool has_failed = false;
        is_memory_out = true;
        try {
            const Value copy(*value);
        } catch (const std::bad_alloc&) {
            has_failed = true;
        }
        is_memory_out = false;
        EXPECT_TRUE(has_failed);
        EXPECT_EQ(Value(*value), *value);
    }
}

TEST(Number, TakesTheSuffixesOfItsUnit) {
    const KeySpec& height = keyOf("desk", "height");
    EXPECT_EQ(number(height, "2.5"), 2.5);
    EXPECT_EQ(number(height, "+2.5"), 2.5);
    EXPECT_EQ(number(height, "2.5m"), 2.5);
    EXPECT_EQ(number(height, "5cm"), 0.05);
    EXPECT_EQ(number(height, "30.1cm"), 0.301);
    EXPECT_EQ(number(height, "1234mm"), 1.234);
    EXPECT_EQ(number(height, "0.05km"), 50);
    EXPECT_EQ(number(height, "1e1cm"), 0.1);
    const KeySpec& fov = keyOf("laser", "fov");
    EXPECT_EQ(number(fov, "30deg"), 30);
    EXPECT_DOUBLE_EQ(number(fov, "0.5rad"), 28.64788975654116);
    const KeySpec& period = keyOf("laser", "period");
    EXPECT_EQ(number(period, "100ms"), 0.1);
    EXPECT_EQ(number(period, "7us"), 7e-6);
    EXPECT_EQ(number(period, "2s"), 2);
    EXPECT_EQ(number(period, "50ns"), 5e-8);
    EXPECT_EQ(number(period, "0.1min"), 6);
    EXPECT_EQ(number(period, "1.5h"), 5400);
    EXPECT_EQ(number(keyOf("result", "area"), "3m2"), 3);
    EXPECT_EQ(number(keyOf("result", "rate"), "40Hz"), 40);
}

TEST(Number, RefusesOtherSuffixes) {
    const KeySpec& height = keyOf("desk", "height");
    EXPECT_EQ(refusal(height, "5kg"), "`5kg` has the unit `kg`, wanted m, km, cm or mm");
    EXPECT_EQ(refusal(height, "5deg"), "`5deg` has the unit `deg`, wanted m, km, cm or mm");
    EXPECT_EQ(refusal(height, "5M"), "`5M` has the unit `M`, wanted m, km, cm or mm");
    EXPECT_EQ(refusal(height, "5cmx"), "`5cmx` has the unit `cmx`, wanted m, km, cm or mm");
    EXPECT_EQ(refusal(height, "0x10"), "`0x10` has the unit `x10`, wanted m, km, cm or mm");
    EXPECT_EQ(refusal(keyOf("laser", "fov"), "5cm"), "`5cm` has the unit `cm`, wanted deg or rad");
    EXPECT_EQ(refusal(keyOf("laser", "period"), "5m"),
              "`5m` has the unit `m`, wanted s, ms, us, ns, min or h");
    EXPECT_EQ(refusal(keyOf("laser", "period"), "1e308h"),
              "`1e308h` is beyond the range of numbers");
    EXPECT_EQ(refusal(keyOf("result", "factor"), "5m"),
              "`5m` has the unit `m`, wanted a number without unit");
}

TEST(Number, IsTakenWhole) {
    const KeySpec& height = keyOf("desk", "height");
    for (const char* text : {"tall", "1.2.3", "1-2", "--1", "+-1", "-", ".", "%", "5 cm", " 5",
                             "5 ", "1_000", "e5", "cm", "nano", "1\xc2\xb2"})
        EXPECT_EQ(refusal(height, text), '`' + std::string(text) + "` is not a number");
    EXPECT_EQ(refusal(height, ""), "a number is missing");
    EXPECT_EQ(refusal(height, "1,5"), "`1,5` is a list, one number is wanted");
    EXPECT_EQ(refusal(height, "1;5"), "`1;5` is a list, one number is wanted");
    EXPECT_LT(refusal(height, std::string(100000, '9') + "x").size(), 200U);
}

TEST(Number, IsFinite) {
    const KeySpec& factor = keyOf("result", "factor");
    for (const char* text : {"NaN", "nan", "-nan", "NAN", ".nan", ".NaN"})
        EXPECT_EQ(refusal(factor, text), "NaN (not a number) is given, a number is wanted") << text;
    for (const char* text : {"inf", "-inf", "+Inf", "Infinity", ".inf", "-.INF"})
        EXPECT_EQ(refusal(factor, text),
                  '`' + std::string(text) + "` is infinite, a finite number is wanted");
    EXPECT_EQ(refusal(factor, "1e999"), "`1e999` is beyond the range of numbers");
    EXPECT_EQ(refusal(keyOf("desk", "height"), "1e308km"),
              "`1e308km` is beyond the range of numbers");
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(checkValue(factor, nan), FormatError);
    EXPECT_THROW(checkValue(factor, HUGE_VAL), FormatError);
    EXPECT_THROW(checkValue(keyOf("desk", "at"), Tuple{1, nan}), FormatError);
    EXPECT_THROW(checkValue(keyOf("fence", "path"), TupleList{{1, nan}}), FormatError);
}

TEST(Number, KeepsItsBounds) {
    const KeySpec& fov = keyOf("laser", "fov");
    EXPECT_EQ(refusal(fov, "0"), "");
    EXPECT_EQ(refusal(fov, "360"), "");
    EXPECT_EQ(refusal(fov, "-3"), "-3 is below 0");
    EXPECT_EQ(refusal(fov, "361deg"), "361 is above 360");
    const KeySpec& height = keyOf("desk", "height");
    EXPECT_EQ(refusal(height, "0"), "0 is given, must be above 0");
    EXPECT_EQ(refusal(height, "-1cm"), "-0.01 is given, must be above 0");
    EXPECT_EQ(refusal(height, "1e-300"), "");
    EXPECT_EQ(refusal(keyOf("laser", "range"), "0,-1"), "-1 is below 0");
}

TEST(Share, IsPerCentOrFraction) {
    const KeySpec& coverage = keyOf("result", "coverage");
    EXPECT_EQ(number(coverage, "97.4%"), 0.974);
    EXPECT_EQ(number(coverage, "0.974"), 0.974);
    EXPECT_EQ(formatValue(coverage, 0.974), "97.4%");
    EXPECT_EQ(refusal(coverage, "95"), "`95` is above 1, write 95% or 0.95");
    EXPECT_EQ(refusal(coverage, "101%"), "`101%` is above 100%, write 95% or 0.95");
    EXPECT_EQ(refusal(coverage, "-1%"), "`-1%` is below 0, write 95% or 0.95");
    EXPECT_EQ(refusal(coverage, "most"), "`most` is not a share, write 95% or 0.95");
    EXPECT_EQ(refusal(coverage, "nan"), "NaN (not a number) is given, a number is wanted");
}

TEST(Tuples, TakeUnitsAndBlanks) {
    const KeySpec& at = keyOf("desk", "at");
    EXPECT_EQ(std::get<Tuple>(parseValue(at, "5cm,-3m,1e1mm")), (Tuple{0.05, -3, 0.01}));
    EXPECT_EQ(std::get<Tuple>(parseValue(at, " 2, 3 ")), (Tuple{2, 3}));
    const KeySpec& path = keyOf("fence", "path");
    EXPECT_EQ(std::get<TupleList>(parseValue(path, "0,0;8m,50cm")), (TupleList{{0, 0}, {8, 0.5}}));
    EXPECT_EQ(std::get<TupleList>(parseValue(path, "0, 0; 8, 1")), (TupleList{{0, 0}, {8, 1}}));
}

TEST(Tuples, KeepTheirCounts) {
    const KeySpec& at = keyOf("desk", "at");
    EXPECT_EQ(refusal(at, "1"), "1 number given, 2 or 3 wanted");
    EXPECT_EQ(refusal(at, "1,2,3,4"), "4 numbers given, 2 or 3 wanted");
    EXPECT_EQ(refusal(at, ""), "a number is missing");
    EXPECT_EQ(refusal(at, "1,,2"), "a number is missing");
    EXPECT_EQ(refusal(at, "1,2,"), "a number is missing");
    EXPECT_EQ(refusal(at, "1,2;3,4"), "`1,2;3,4` is a `;` list, one tuple is wanted");
    EXPECT_EQ(refusal(at, "1,x"), "`x` is not a number");
    KeySpec five = at;
    five.min_count = 3;
    five.max_count = 5;
    EXPECT_EQ(refusal(five, "1"), "1 number given, 3 to 5 wanted");
    five.max_count = static_cast<std::size_t>(-1);
    EXPECT_EQ(refusal(five, "1"), "1 number given, at least 3 wanted");
    const KeySpec& path = keyOf("fence", "path");
    EXPECT_EQ(refusal(path, "0,0;1"), "1 number given in tuple 2, 2 wanted");
    EXPECT_EQ(refusal(path, "0,0;"), "tuple 2 is empty");
    EXPECT_EQ(refusal(path, ""), "tuple 1 is empty");
    EXPECT_THROW(checkValue(path, TupleList{}), FormatError);
}

TEST(Flag, HasThreePairsOfWords) {
    const KeySpec& closed = keyOf("desk", "closed");
    for (const char* text : {"yes", "true", "on", "Yes", "TRUE"})
        EXPECT_TRUE(std::get<bool>(parseValue(closed, text))) << text;
    for (const char* text : {"no", "false", "off", "False"})
        EXPECT_FALSE(std::get<bool>(parseValue(closed, text))) << text;
    EXPECT_EQ(refusal(closed, "maybe"), "`maybe` is neither yes nor no");
    EXPECT_EQ(refusal(closed, "falsehood"), "`falsehood` is neither yes nor no");
    EXPECT_EQ(refusal(closed, ""), "`` is neither yes nor no");
}

TEST(Words, HaveNoOtherSigns) {
    const KeySpec& id = keyOf("desk", "id");
    EXPECT_EQ(refusal(id, "aZ0_-./+:@"), "");
    for (const char* text : {"", "a b", "a=b", "a,b", "a#", "\"", "h\xc3\xb6he"})
        EXPECT_EQ(refusal(id, text), '`' + std::string(text) +
                                         "` is not a word: letters, digits and _-./+:@ are wanted");
}

TEST(Choice, HintsAtTheNearest) {
    const KeySpec& kind = keyOf("desk", "kind");
    EXPECT_EQ(refusal(kind, "two words"), "");
    EXPECT_EQ(refusal(kind, "close"),
              "`close` is none of open, closed, two words, did you mean `closed`?");
    EXPECT_EQ(refusal(kind, "red"), "`red` is none of open, closed, two words");
}

TEST(Text, IsWhatALineCanHold) {
    const KeySpec& name = keyOf("desk", "name");
    EXPECT_EQ(refusal(name, ""), "");
    EXPECT_EQ(refusal(name, "a\tb\nc \" \\ # = \xe2\x82\xac"), "");
    EXPECT_EQ(refusal(name, "a\x01"), "the text holds a control character");
    EXPECT_EQ(refusal(name, "a\r"), "the text holds a control character");
    EXPECT_EQ(refusal(name, std::string_view("\0", 1)), "the text holds a control character");
    EXPECT_EQ(refusal(name, "r\xe9sum\xe9"), "the text is not UTF-8");
}

TEST(FormatValue, QuotesWhereNeeded) {
    const KeySpec& name = keyOf("desk", "name");
    const auto format = [&](const char* text) { return formatValue(name, std::string(text)); };
    EXPECT_EQ(format("plain=word;,'\\"), "plain=word;,'\\");
    EXPECT_EQ(format(""), "\"\"");
    EXPECT_EQ(format("two words"), "\"two words\"");
    EXPECT_EQ(format("a#b"), "\"a#b\"");
    EXPECT_EQ(format("say \"x\\y\"\n\t"), R"("say \"x\\y\"\n\t")");
    EXPECT_EQ(formatValue(keyOf("desk", "kind"), std::string("two words")), "\"two words\"");
}

TEST(FormatValue, IsShortest) {
    EXPECT_EQ(formatValue(keyOf("desk", "closed"), true), "yes");
    EXPECT_EQ(formatValue(keyOf("desk", "closed"), false), "no");
    EXPECT_EQ(formatValue(keyOf("desk", "at"), Tuple{0.1, -0.0, 1e20}), "0.1,0,1e+20");
    EXPECT_EQ(formatValue(keyOf("fence", "path"), TupleList{{0, 0}, {8, 0.5}}), "0,0;8,0.5");
}

TEST(Values, OfTheWrongTypeAreABug) {
    EXPECT_THROW(checkValue(keyOf("desk", "at"), 1.0), std::logic_error);
    EXPECT_THROW((void)formatValue(keyOf("desk", "closed"), std::string("yes")), std::logic_error);
}

TEST(Schemas, FindTheirKeywords) {
    EXPECT_EQ(testSchemas().find("desk")->help, "a desk");
    EXPECT_EQ(testSchemas().find("dest"), nullptr);
    EXPECT_EQ(testSchemas().keywords(),
              (std::vector<std::string>{"desk", "fence", "laser", "result"}));
    EXPECT_EQ(testSchemas().find("fence")->keyNames(),
              (std::vector<std::string>{"id", "path", "closed"}));
    EXPECT_EQ(testSchemas().find("fence")->find("paht"), nullptr);
    EXPECT_TRUE(testSchemas().find("fence")->isEnvironment());
    EXPECT_FALSE(testSchemas().find("laser")->isEnvironment());
    EXPECT_FALSE(testSchemas().find("result")->isEnvironment());
}

TEST(Schemas, RefuseWhatModulesGetWrong) {
    const KeySpec id = testKey("id", KeyType::Word);
    const auto make = [](std::vector<Schema> schemas) { return Schemas(std::move(schemas)); };
    const Schema good{"a", RecordType::Other, "", {id}};
    EXPECT_NO_THROW(make({good}));
    EXPECT_THROW(make({good, good}), std::logic_error);
    EXPECT_THROW(make({{"a", RecordType::Other, "", {}}}), std::logic_error);
    EXPECT_THROW(make({{"a", RecordType::Other, "", {testKey("x", KeyType::Flag), id}}}),
                 std::logic_error);
    EXPECT_THROW(make({{"a", RecordType::Other, "", {id, id}}}), std::logic_error);
    EXPECT_THROW(make({{"a b", RecordType::Other, "", {id}}}), std::logic_error);
    KeySpec wrong = testKey("x", KeyType::Number);
    wrong.default_value = std::string("1");
    EXPECT_THROW(make({{"a", RecordType::Other, "", {id, wrong}}}), std::logic_error);
    wrong.default_value = -1.0;
    wrong.lower = 0;
    EXPECT_THROW(make({{"a", RecordType::Other, "", {id, wrong}}}), FormatError);
}

TEST(ParseValue, TakesSizesAsTheyAreSpoken) {
    KeySpec size = testKey("size", KeyType::Tuple, Unit::Length);
    size.max_count = 3;
    const auto parse = [](const KeySpec& key, std::string_view text) {
        return std::get<Tuple>(parseValue(key, text));
    };
    for (const char* text : {"8 \xc3\x97 6", "8\u00d76", "8x6", "8 X 6", "8 * 6", " 8*6 ",
                             "800cm x 6m", "8,6", "+8 x 6.0"})
        EXPECT_EQ(parse(size, text), (Tuple{8, 6})) << text;
    EXPECT_EQ(parse(size, "8x8x2.5"), (Tuple{8, 8, 2.5}));
    EXPECT_EQ(formatValue(size, parse(size, "8 \xc3\x97 6")), "8,6");
    const auto refused = [&](const KeySpec& key, const char* text) {
        return findingsOf([&] { (void)parseValue(key, text); }).at(0);
    };
    EXPECT_EQ(refused(size, "x"), "error: `size`: `x` is not a number");
    EXPECT_EQ(refused(size, "8x"), "error: `size`: a number is missing");
    EXPECT_EQ(refused(size, "8 x tall"), "error: `size`: `tall` is not a number");
    EXPECT_EQ(refused(size, "8x6*2"), "error: `size`: `6*2` is not a number");
    EXPECT_EQ(refused(size, "8x6,2"),
              "error: `size`: `8x6` has the unit `x6`, wanted m, km, cm or mm");
    KeySpec pixels = testKey("pixels", KeyType::Tuple);
    pixels.max_count = 2;
    EXPECT_EQ(refused(pixels, "8 x 6"), "error: `pixels`: `8 x 6` is not a number")
        << "neither lengths nor counts";
    pixels.whole = true;
    EXPECT_EQ(parse(pixels, "640x480"), (Tuple{640, 480}));
    KeySpec path = testKey("path", KeyType::TupleList, Unit::Length);
    path.max_count = 2;
    EXPECT_EQ(findingsOf([&] { (void)parseValue(path, "8x6;1,2"); }).size(), 1U);
}

}  // namespace value_test
}  // namespace ispace
