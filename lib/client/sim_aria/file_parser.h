// SPDX-License-Identifier: GPL-3.0-or-later
// Files of lines that begin with a keyword, read by functions of the program.
#ifndef SIM_ARIA_FILE_PARSER_H
#define SIM_ARIA_FILE_PARSER_H

#include <cctype>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include <sim_aria/arguments.h>
#include <sim_aria/functor.h>

/// Calls a function for each line of a file, by its first word; comments begin with ; or #. The
/// function gets the other words, and returns false for an error.
class ArFileParser {
  public:
    using Handler = ArRetFunctor1<bool, ArArgumentBuilder*>;

    explicit ArFileParser(const char* baseDirectory = "./") : myDirectory(baseDirectory) {}
    virtual ~ArFileParser() {}

    const char* getBaseDirectory() const { return myDirectory.c_str(); }
    void setBaseDirectory(const char* directory) { myDirectory = directory; }
    /// \param keyword in any case; null: of all lines whose word has no function
    /// \return false if the word has one already
    bool addHandler(const char* keyword, Handler* functor) {
        return myHandlers.emplace(keyOf(keyword), functor).second;
    }
    bool remHandler(const char* keyword) { return myHandlers.erase(keyOf(keyword)) > 0; }
    bool remHandler(Handler* functor) {
        bool found = false;
        for (auto at = myHandlers.begin(); at != myHandlers.end();) {
            const bool same = at->second == functor;
            found = found || same;
            at = same ? myHandlers.erase(at) : std::next(at);
        }
        return found;
    }
    /// Reads a file, relative to the base directory. \return false if it cannot be opened, or a
    /// line has an error; `continueOnErrors` reads the lines after it, too
    bool parseFile(const char* fileName, bool continueOnErrors = true,
                   bool noFileNotFoundMessage = false) {
        const bool whole = *fileName == '/' || myDirectory.empty();
        const bool slash = !whole && myDirectory.back() != '/';
        std::ifstream file((whole ? "" : myDirectory + (slash ? "/" : "")) + fileName);
        if (!file) {
            if (!noFileNotFoundMessage) ArLog::log(ArLog::Terse, "cannot open %s", fileName);
            return false;
        }
        bool good = true;
        std::string line;
        for (int number = 1; std::getline(file, line); ++number) {
            if (parseLine(line)) continue;
            ArLog::log(ArLog::Terse, "%s:%d: bad line `%s`", fileName, number, line.c_str());
            good = false;
            if (!continueOnErrors) return false;
        }
        return good;
    }
    /// Calls the function of one line. \return false for an error
    bool parseLine(const std::string& line) {
        ArArgumentBuilder words;
        words.addPlain(line.substr(0, line.find_first_of(";#")).c_str());
        if (words.getArgc() == 0) return true;
        const std::string keyword = words.getArg(0);
        auto found = myHandlers.find(keyOf(keyword.c_str()));
        const bool known = found != myHandlers.end();
        if (!known) found = myHandlers.find(keyOf(nullptr));
        if (found == myHandlers.end()) {
            ArLog::log(ArLog::Terse, "the word %s is unknown", keyword.c_str());
            return false;
        }
        words.setExtraString(keyword.c_str());
        if (known) words.removeArg(0);
        return found->second->invokeR(&words);
    }

  private:
    static std::string keyOf(const char* keyword) {
        std::string key = keyword ? keyword : "";
        for (char& c : key) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        return key;
    }

    std::string myDirectory;
    std::map<std::string, Handler*> myHandlers;
};

#endif  // SIM_ARIA_FILE_PARSER_H
