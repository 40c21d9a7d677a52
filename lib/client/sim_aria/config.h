// SPDX-License-Identifier: GPL-3.0-or-later
// Values take effect line by line: after an error that ends parseFile() those before it stay.
// Options of the command line are taken after the whole file, at each parseFile().
#ifndef SIM_ARIA_CONFIG_H
#define SIM_ARIA_CONFIG_H

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <list>
#include <string>
#include <vector>

#include <sim_aria/argument.h>
#include <sim_aria/arguments.h>
#include <sim_aria/aria.h>

/// A parameter of a configuration.
class ArConfigArg : public ArArg {
  public:
    ArConfigArg() {}
    template <class... Arguments>
    explicit ArConfigArg(const char* name, Arguments... arguments) : ArArg(name, arguments...) {}
    ArPriority::Priority getConfigPriority() const { return myPriority; }
    void setConfigPriority(ArPriority::Priority priority) { myPriority = priority; }

  private:
    ArPriority::Priority myPriority = ArPriority::NORMAL;
};

/// Parameters under one heading.
class ArConfigSection {
  public:
    explicit ArConfigSection(const char* name, const char* comment = "")
        : myName(name), myComment(comment) {}
    const char* getName() const { return myName.c_str(); }
    const char* getComment() const { return myComment.c_str(); }
    void setComment(const char* comment) { myComment = comment; }
    std::list<ArConfigArg>* getParams() { return &myParams; }
    ArConfigArg* findParam(const char* name) {
        for (ArConfigArg& param : myParams)
            if (ArUtil::strcasequal(param.getName(), name)) return &param;
        return nullptr;
    }

  private:
    std::string myName, myComment;
    std::list<ArConfigArg> myParams;
};

/// Parameters of a program, read from and written to text files:
///
///     Section Avoidance
///     Distance 450     ; mm
class ArConfig {
  public:
    explicit ArConfig(const char* baseDirectory = nullptr)
        : myDirectory(baseDirectory ? baseDirectory : "") {}
    virtual ~ArConfig() {}

    void setBaseDirectory(const char* directory) { myDirectory = directory; }
    const char* getBaseDirectory() const { return myDirectory.c_str(); }
    /// \return false if the section has a parameter with this name
    bool addParam(const ArConfigArg& arg, const char* sectionName = "",
                  ArPriority::Priority priority = ArPriority::NORMAL) {
        ArConfigSection& section = findOrAdd(sectionName);
        if (section.findParam(arg.getName())) return false;
        section.getParams()->push_back(arg);
        section.getParams()->back().setConfigPriority(priority);
        return true;
    }
    void setSectionComment(const char* sectionName, const char* comment) {
        findOrAdd(sectionName).setComment(comment);
    }
    std::list<ArConfigSection*>* getSections() {
        myPointers.clear();
        for (ArConfigSection& section : mySections) myPointers.push_back(&section);
        return &myPointers;
    }
    ArConfigSection* findSection(const char* name) {
        for (ArConfigSection& section : mySections)
            if (ArUtil::strcasequal(section.getName(), name)) return &section;
        return nullptr;
    }
    /// Functions to call after a file was read; false is an error.
    void addProcessFileCB(ArRetFunctor<bool>* functor, int priority = 0) {
        myCallbacks.add(functor, priority, functor);
    }
    void remProcessFileCB(ArRetFunctor<bool>* functor) { myCallbacks.remove(functor); }
    bool callProcessFileCallBacks(bool continueOnError, char* errorBuffer = nullptr,
                                  std::size_t errorBufferLen = 0) {
        bool good = true;
        for (const auto& item : std::list<Callbacks::Item>(myCallbacks.items())) {
            if (item.call->invokeR()) continue;
            good = false;
            report("a callback rejected the configuration", errorBuffer, errorBufferLen);
            if (!continueOnError) return false;
        }
        return good;
    }

    /// Reads a file, relative to the base directory, then calls the callbacks. Unknown parameters
    /// are skipped, and, if `sectionsToParse` is given, all other sections. Options of the command
    /// line come before the file: see useArgumentParser().
    bool parseFile(const char* fileName, bool continueOnError = false,
                   bool noFileNotFoundMessage = false, char* errorBuffer = nullptr,
                   std::size_t errorBufferLen = 0,
                   std::list<std::string>* sectionsToParse = nullptr) {
        if (errorBuffer && errorBufferLen > 0) *errorBuffer = 0;
        std::ifstream file(path(fileName));
        if (!file) {
            const std::string text = std::string("cannot open ") + fileName;
            if (!noFileNotFoundMessage) ArLog::log(ArLog::Terse, "%s", text.c_str());
            report(text, errorBuffer, errorBufferLen);
            return false;
        }
        ArConfigSection* section = findSection("");
        std::string line;
        bool good = true;
        for (int number = 1; std::getline(file, line); ++number) {
            if (parseLine(line, &section, sectionsToParse)) continue;
            report(fileName + (":" + std::to_string(number)) + ": bad value in `" + line + "`",
                   errorBuffer, errorBufferLen);
            good = false;
            if (!continueOnError) return false;
        }
        if (!parseOptions()) {
            report("an option of the command line has a bad value", errorBuffer, errorBufferLen);
            good = false;
            if (!continueOnError) return false;
        }
        return processFile() &&
               callProcessFileCallBacks(continueOnError, errorBuffer, errorBufferLen) && good;
    }
    /// Called after a file was read, before the callbacks; false is an error.
    virtual bool processFile() { return true; }
    /// Lets parseFile() take options by the names of the parameters, as in `-Distance 300`: they
    /// overrule the file.
    void useArgumentParser(ArArgumentParser* parser) { myParser = parser; }
    bool writeFile(const char* fileName, bool /*append*/ = false) {
        std::FILE* const file = std::fopen(path(fileName).c_str(), "w");
        if (!file) return false;
        for (ArConfigSection& section : mySections) {
            if (section.getParams()->empty()) continue;
            std::fprintf(file, "Section %s\n", section.getName());
            if (*section.getComment() != 0) std::fprintf(file, "; %s\n", section.getComment());
            for (const ArConfigArg& param : *section.getParams())
                for (const std::string& text : param.texts())
                    std::fprintf(file, "%s %s\t; %s\n", param.getName(), text.c_str(),
                                 param.getDescription());
            std::fprintf(file, "\n");
        }
        const bool written = std::ferror(file) == 0;
        return std::fclose(file) == 0 && written;
    }

  private:
    using Callbacks = sim_aria::Ordered<ArRetFunctor<bool>*>;

    static void report(const std::string& text, char* buffer, std::size_t length) {
        if (buffer && length > 0) std::snprintf(buffer, length, "%s", text.c_str());
    }
    static std::string trimmed(const std::string& text) {
        const char* const spaces = " \t\r";
        const std::size_t first = text.find_first_not_of(spaces);
        if (first == std::string::npos) return "";
        return text.substr(first, text.find_last_not_of(spaces) - first + 1);
    }
    std::string path(const char* name) const {
        if (*name == '/' || myDirectory.empty()) return name;
        return myDirectory + (myDirectory.back() == '/' ? "" : "/") + name;
    }
    bool parseOptions() {
        bool good = true;
        for (ArConfigSection& section : mySections)
            for (ArConfigArg& param : *section.getParams()) {
                if (!myParser || param.getType() == ArArg::FUNCTOR) continue;
                if (const char* const text = myParser->checkParameterArgument(param.getName()))
                    good = param.setText(text) && good;
            }
        return good;
    }
    bool parseLine(const std::string& line, ArConfigSection** section,
                   const std::list<std::string>* wanted) {
        const std::string text = trimmed(line.substr(0, line.find_first_of(";#")));
        if (text.empty()) return true;
        const std::size_t space = text.find_first_of(" \t");
        const std::string name = text.substr(0, space);
        const std::string value = space == std::string::npos ? "" : trimmed(text.substr(space));
        if (ArUtil::strcasequal(name, "section")) {
            *section = findSection(value.c_str());
            const bool is_wanted =
                !wanted || std::any_of(wanted->begin(), wanted->end(), [&](const std::string& one) {
                    return ArUtil::strcasequal(one, value);
                });
            if (!is_wanted) *section = nullptr;
            return true;
        }
        ArConfigArg* const param = *section ? (*section)->findParam(name.c_str()) : nullptr;
        return !param || param->setText(value);
    }
    ArConfigSection& findOrAdd(const char* name) {
        if (ArConfigSection* const section = findSection(name)) return *section;
        mySections.emplace_back(name);
        return mySections.back();
    }

    std::string myDirectory;
    std::list<ArConfigSection> mySections;
    std::list<ArConfigSection*> myPointers;
    Callbacks myCallbacks;
    ArArgumentParser* myParser = nullptr;
};

inline ArConfig* Aria::getConfig() {
    // Never destroyed: callbacks of other objects may use it at the end.
    static ArConfig* const config = new ArConfig;
    return config;
}

#endif  // SIM_ARIA_CONFIG_H
