// SPDX-License-Identifier: GPL-3.0-or-later
// The parser takes the words that it knows out of argc and argv themselves, so that the rest is the
// program's. Texts that it returns live as long as argv, those of default arguments as long as the
// parser.
#ifndef SIM_ARIA_ARGUMENTS_H
#define SIM_ARIA_ARGUMENTS_H

#include <cctype>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <list>
#include <string>
#include <vector>

#include <sim_aria/util.h>

namespace sim_aria {

inline bool isInt(long long value) {
    return value >= std::numeric_limits<int>::min() && value <= std::numeric_limits<int>::max();
}

}  // namespace sim_aria

/// Builds a list of words.
class ArArgumentBuilder {
  public:
    ArArgumentBuilder() {}
    ArArgumentBuilder(const ArArgumentBuilder& other)
        : myWords(other.myWords), myExtra(other.myExtra) {
        refer();
    }
    ArArgumentBuilder& operator=(const ArArgumentBuilder& other) {
        myWords = other.myWords;
        myExtra = other.myExtra;
        refer();
        return *this;
    }
    virtual ~ArArgumentBuilder() {}

    /// Splits text at spaces; quotes keep a word together.
    void addPlain(const char* text) {
        std::string word;
        bool quoted = false, begun = false;
        for (; *text != 0; ++text) {
            if (*text == '"') {
                quoted = !quoted;
                begun = true;
            } else if (!quoted && std::isspace(static_cast<unsigned char>(*text))) {
                if (begun) myWords.push_back(word);
                word.clear();
                begun = false;
            } else {
                word += *text;
                begun = true;
            }
        }
        if (begun) myWords.push_back(word);
        refer();
    }
    void add(const char* text, ...) __attribute__((format(printf, 2, 3))) {
        char line[2048];
        va_list values;
        va_start(values, text);
        std::vsnprintf(line, sizeof line, text, values);
        va_end(values);
        addPlain(line);
    }
    std::size_t getArgc() const { return myWords.size(); }
    char** getArgv() { return myPointers.data(); }
    const char* getArg(std::size_t i) const {
        return i < myWords.size() ? myWords[i].c_str() : nullptr;
    }
    /// The word as a number, 0 if it is none or beyond an int; `ok` tells which.
    int getArgInt(std::size_t i, bool* ok = nullptr) const {
        return static_cast<int>(parsed(i, ok, [](const char* text, char** end) {
            const long long value = std::strtoll(text, end, 10);
            // No number ends at its begin.
            if (!sim_aria::isInt(value)) *end = const_cast<char*>(text);
            return static_cast<double>(value);
        }));
    }
    double getArgDouble(std::size_t i, bool* ok = nullptr) const {
        return parsed(i, ok, [](const char* text, char** end) { return std::strtod(text, end); });
    }
    /// true or 1, false or 0
    bool getArgBool(std::size_t i, bool* ok = nullptr) const {
        const char* const text = i < myWords.size() ? getArg(i) : "";
        const bool on = ArUtil::strcasequal(text, "true") || std::strcmp(text, "1") == 0;
        if (ok) *ok = on || ArUtil::strcasequal(text, "false") || std::strcmp(text, "0") == 0;
        return on;
    }
    bool isArgInt(std::size_t i) const {
        bool ok = false;
        getArgInt(i, &ok);
        return ok;
    }
    bool isArgDouble(std::size_t i) const {
        bool ok = false;
        getArgDouble(i, &ok);
        return ok;
    }
    bool isArgBool(std::size_t i) const {
        bool ok = false;
        getArgBool(i, &ok);
        return ok;
    }
    void removeArg(std::size_t i) {
        if (i >= myWords.size()) return;
        myWords.erase(myWords.begin() + static_cast<std::ptrdiff_t>(i));
        refer();
    }
    /// Words as they are, such as those of the command line.
    void addStrings(int argc, char** argv) {
        myWords.insert(myWords.end(), argv, argv + argc);
        refer();
    }
    /// All words, with spaces between.
    const char* getFullString() const { return myText.c_str(); }
    /// Text that goes with the words, such as the keyword before them.
    const char* getExtraString() const { return myExtra.c_str(); }
    void setExtraString(const char* text) { myExtra = text; }
    void log() const {
        for (const std::string& word : myWords) ArLog::log(ArLog::Terse, "\t%s", word.c_str());
    }

  private:
    template <class Parse>
    double parsed(std::size_t i, bool* ok, const Parse& parse) const {
        const char* const text = i < myWords.size() ? getArg(i) : "";
        char* end = nullptr;
        const double value = parse(text, &end);
        const bool good = end != text && *end == 0;
        if (ok) *ok = good;
        return good ? value : 0;
    }
    void refer() {
        myPointers.clear();
        for (std::string& word : myWords) myPointers.push_back(&word[0]);
        myPointers.push_back(nullptr);
        myText.clear();
        for (const std::string& word : myWords) myText += (myText.empty() ? "" : " ") + word;
    }

    std::vector<std::string> myWords;
    std::string myText, myExtra;
    std::vector<char*> myPointers;
};

/// The words of the command line, without those already parsed; default arguments follow them.
class ArArgumentParser {
  public:
    ArArgumentParser(int* argc, char** argv) : myCount(argc), myWords(argv) {}
    explicit ArArgumentParser(ArArgumentBuilder* builder)
        : myOwnCount(static_cast<int>(builder->getArgc())),
          myCount(&myOwnCount),
          myWords(builder->getArgv()),
          myFirst(0) {}
    virtual ~ArArgumentParser() {}
    ArArgumentParser(const ArArgumentParser&) = delete;
    ArArgumentParser& operator=(const ArArgumentParser&) = delete;

    /// Adds the words of the variable ARIAARGS.
    void loadDefaultArguments(int /*position*/ = 1) {
        if (const char* const words = std::getenv("ARIAARGS")) addDefaultArgument(words);
    }
    void addDefaultArgument(const char* words, int /*position*/ = 1) { myDefaults.addPlain(words); }

    /// Finds and removes `-word` or `--word`.
    bool checkArgument(const char* word) {
        const int i = find(word);
        if (i >= 0) {
            take(i, 1);
            return true;
        }
        const std::size_t k = findDefault(word);
        myDefaults.removeArg(k);
        return k != kNone;
    }
    /// Finds and removes an option; returns its value, null if missing.
    const char* checkParameterArgument(const char* word) {
        bool found = false;
        return value(word, &found);
    }
    /// The same into a variable. \return false if the value is missing or wrong
    bool checkParameterArgumentString(const char* word, const char** to,
                                      bool* wasReallySet = nullptr) {
        bool found = false;
        const char* const text = value(word, &found);
        if (wasReallySet) *wasReallySet = text != nullptr;
        if (text) *to = text;
        return !found || text;
    }
    bool checkParameterArgumentInteger(const char* word, int* to, bool* wasReallySet = nullptr) {
        return number(word, wasReallySet, [to](const char* text, char** end) {
            const long long read = std::strtoll(text, end, 10);
            if (!sim_aria::isInt(read)) *end = const_cast<char*>(text);
            if (**end == 0) *to = static_cast<int>(read);
        });
    }
    bool checkParameterArgumentDouble(const char* word, double* to, bool* wasReallySet = nullptr) {
        return number(word, wasReallySet, [to](const char* text, char** end) {
            const double read = std::strtod(text, end);
            if (**end == 0) *to = read;
        });
    }
    bool checkParameterArgumentFloat(const char* word, float* to, bool* wasReallySet = nullptr) {
        double read = *to;
        const bool good = checkParameterArgumentDouble(word, &read, wasReallySet);
        *to = static_cast<float>(read);
        return good;
    }
    bool checkParameterArgumentBool(const char* word, bool* to, bool* wasReallySet = nullptr) {
        bool found = false;
        const char* const text = value(word, &found);
        const bool on = text && (ArUtil::strcasequal(text, "true") || std::strcmp(text, "1") == 0);
        const bool off =
            text && (ArUtil::strcasequal(text, "false") || std::strcmp(text, "0") == 0);
        if (wasReallySet) *wasReallySet = on || off;
        if (on || off) *to = on;
        return !found || on || off;
    }
    /// \return false if help is requested, or words are left
    bool checkHelpAndWarnUnparsed(unsigned int numArgsOkay = 0) {
        if (checkArgument("-help") || checkArgument("-h")) return false;
        const int first = myFirst + static_cast<int>(numArgsOkay);
        for (int i = first; i < *myCount; ++i)
            ArLog::log(ArLog::Terse, "Unknown argument: %s", myWords[i]);
        return *myCount <= first;
    }
    std::size_t getArgc() const { return static_cast<std::size_t>(*myCount); }
    char** getArgv() const { return myWords; }
    const char* getArg(std::size_t i) const { return i < getArgc() ? myWords[i] : nullptr; }
    void removeArg(std::size_t i) {
        if (i < getArgc()) take(static_cast<int>(i), 1);
    }
    void log() const {
        for (int i = myFirst; i < *myCount; ++i)
            ArLog::log(ArLog::Terse, "argument: %s", myWords[i]);
    }

  private:
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

    static bool same(const char* found, const char* word) {
        return std::strcmp(found, word) == 0 ||
               (found[0] == '-' && std::strcmp(found + 1, word) == 0);
    }
    /// Programs name options with and without the hyphen.
    static std::string hyphened(const char* word) {
        return word[0] == '-' ? word : std::string("-") + word;
    }
    int find(const char* word) const {
        const std::string option = hyphened(word);
        for (int i = myFirst; i < *myCount; ++i)
            if (same(myWords[i], option.c_str())) return i;
        return -1;
    }
    std::size_t findDefault(const char* word) const {
        const std::string option = hyphened(word);
        for (std::size_t i = 0; i < myDefaults.getArgc(); ++i)
            if (same(myDefaults.getArg(i), option.c_str())) return i;
        return kNone;
    }
    void take(int i, int count) {
        for (int k = i; k + count < *myCount; ++k) myWords[k] = myWords[k + count];
        *myCount -= count;
        myWords[*myCount] = nullptr;
    }
    const char* value(const char* word, bool* found) {
        const int i = find(word);
        const std::size_t k = i >= 0 ? kNone : findDefault(word);
        *found = i >= 0 || k != kNone;
        if (i >= 0) {
            const char* const text = i + 1 < *myCount ? myWords[i + 1] : nullptr;
            take(i, text ? 2 : 1);
            return text;
        }
        if (k == kNone) return nullptr;
        const char* const text = myDefaults.getArg(k + 1);
        myKept.push_back(text ? text : "");
        if (text) myDefaults.removeArg(k + 1);
        myDefaults.removeArg(k);
        return text ? myKept.back().c_str() : nullptr;
    }
    template <class Read>
    bool number(const char* word, bool* was_set, const Read& read) {
        bool found = false;
        const char* const text = value(word, &found);
        char junk[] = "x", *end = junk;
        if (text && *text != 0) read(text, &end);
        const bool good = *end == 0;
        if (was_set) *was_set = good;
        if (found && !good)
            ArLog::log(ArLog::Terse, "%s wants a number, found %s", word, text ? text : "none");
        return !found || good;
    }

    int myOwnCount = 0;
    int* myCount;
    char** myWords;
    int myFirst = 1;  // after the name of the program
    ArArgumentBuilder myDefaults;
    std::list<std::string> myKept;  // values that were default arguments
};

#endif  // SIM_ARIA_ARGUMENTS_H
