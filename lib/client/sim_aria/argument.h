// SPDX-License-Identifier: GPL-3.0-or-later
// A parameter points to a variable of the program, which must outlive it; its text is copied into
// arrays of the program, and refused if it does not fit.
#ifndef SIM_ARIA_ARGUMENT_H
#define SIM_ARIA_ARGUMENT_H

#include <cfloat>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <list>
#include <string>
#include <vector>

#include <sim_aria/arguments.h>
#include <sim_aria/functor.h>
#include <sim_aria/typedefs.h>
#include <sim_aria/util.h>

/// A named parameter: refers to a variable of an action or of a configuration.
class ArArg {
  public:
    enum Type { INVALID, INT, DOUBLE, STRING, BOOL, FUNCTOR, DESCRIPTION_HOLDER, SEPARATOR };
    using Setter = ArRetFunctor1<bool, ArArgumentBuilder*>;
    using Getter = ArRetFunctor<const std::list<ArArgumentBuilder*>*>;

    ArArg() {}
    ArArg(const char* name, int* pointer, const char* description = "", int minInt = INT_MIN,
          int maxInt = INT_MAX)
        : myType(INT),
          myName(name),
          myDescription(description),
          myPointer(pointer),
          myMin(minInt),
          myMax(maxInt) {}
    ArArg(const char* name, double* pointer, const char* description = "",
          double minDouble = -DBL_MAX, double maxDouble = DBL_MAX)
        : myType(DOUBLE),
          myName(name),
          myDescription(description),
          myPointer(pointer),
          myMin(minDouble),
          myMax(maxDouble) {}
    ArArg(const char* name, bool* pointer, const char* description = "")
        : myType(BOOL), myName(name), myDescription(description), myPointer(pointer) {}
    /// \param maxStrLen size of the array
    ArArg(const char* name, char* pointer, const char* description, std::size_t maxStrLen)
        : myType(STRING),
          myName(name),
          myDescription(description),
          myPointer(pointer),
          mySize(maxStrLen) {}

    /// A parameter of any number of lines: `set` is called with the words of each that is read,
    /// `get` returns those to write.
    ArArg(const char* name, Setter* set, Getter* get, const char* description)
        : myType(FUNCTOR), myName(name), myDescription(description), mySetter(set), myGetter(get) {}

    Type getType() const { return myType; }
    const char* getName() const { return myName.c_str(); }
    const char* getDescription() const { return myDescription.c_str(); }
    int getInt() const { return myType == INT ? *static_cast<int*>(myPointer) : 0; }
    double getDouble() const { return myType == DOUBLE ? *static_cast<double*>(myPointer) : 0; }
    bool getBool() const { return myType == BOOL && *static_cast<bool*>(myPointer); }
    const char* getString() const {
        return myType == STRING ? static_cast<const char*>(myPointer) : "";
    }
    int getMinInt() const { return myType == INT ? static_cast<int>(myMin) : INT_MIN; }
    int getMaxInt() const { return myType == INT ? static_cast<int>(myMax) : INT_MAX; }
    double getMinDouble() const { return myMin; }
    double getMaxDouble() const { return myMax; }

    /// \return false for a value out of range, or a parameter of another type
    bool setInt(int value) {
        if (myType != INT || value < myMin || value > myMax) return false;
        *static_cast<int*>(myPointer) = value;
        return true;
    }
    bool setDouble(double value) {
        if (myType != DOUBLE || !(value >= myMin && value <= myMax)) return false;
        *static_cast<double*>(myPointer) = value;
        return true;
    }
    bool setBool(bool value) {
        if (myType != BOOL) return false;
        *static_cast<bool*>(myPointer) = value;
        return true;
    }
    bool setString(const char* value) {
        if (myType != STRING || std::strlen(value) >= mySize) return false;
        std::strcpy(static_cast<char*>(myPointer), value);
        return true;
    }
    bool setArgWithFunctor(ArArgumentBuilder* words) {
        return myType == FUNCTOR && mySetter && mySetter->invokeR(words);
    }
    const std::list<ArArgumentBuilder*>* getArgsWithFunctor() const {
        return myType == FUNCTOR && myGetter ? myGetter->invokeR() : nullptr;
    }
    /// Texts of the values, as in a configuration file: one, but for functors.
    std::vector<std::string> texts() const {
        if (myType != FUNCTOR) return std::vector<std::string>(1, text());
        std::vector<std::string> all;
        if (const std::list<ArArgumentBuilder*>* const lines = getArgsWithFunctor())
            for (const ArArgumentBuilder* line : *lines) all.push_back(line->getFullString());
        return all;
    }
    /// Text of the value, as in a configuration file.
    std::string text() const {
        char number[64];
        switch (myType) {
            case INT:
                return std::to_string(getInt());
            case DOUBLE:
                std::snprintf(number, sizeof number, "%.9g", getDouble());
                return number;
            case BOOL:
                return getBool() ? "true" : "false";
            case STRING:
                return getString();
            default:
                return "";
        }
    }
    /// \return false if the text is no value of this type
    bool setText(const std::string& text) {
        char* end = nullptr;
        if (myType == STRING) return setString(text.c_str());
        if (myType == FUNCTOR) {
            ArArgumentBuilder words;
            words.addPlain(text.c_str());
            words.setExtraString(getName());
            return setArgWithFunctor(&words);
        }
        if (myType == BOOL) {
            if (ArUtil::strcasequal(text, "true") || text == "1") return setBool(true);
            return (ArUtil::strcasequal(text, "false") || text == "0") && setBool(false);
        }
        if (text.empty()) return false;
        if (myType == INT) {
            const long value = std::strtol(text.c_str(), &end, 10);
            if (*end != 0 || value < INT_MIN || value > INT_MAX) return false;
            return setInt(static_cast<int>(value));
        }
        const double value = std::strtod(text.c_str(), &end);
        return *end == 0 && setDouble(value);
    }
    void log() const {
        ArLog::log(ArLog::Terse, "\t%s: %s (%s)", getName(), text().c_str(), getDescription());
    }

  private:
    Type myType = INVALID;
    std::string myName, myDescription;
    void* myPointer = nullptr;
    Setter* mySetter = nullptr;
    Getter* myGetter = nullptr;
    double myMin = 0, myMax = 0;
    std::size_t mySize = 0;
};

#endif  // SIM_ARIA_ARGUMENT_H
