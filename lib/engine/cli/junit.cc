// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/junit.h"

#include <algorithm>
#include <exception>
#include <pugixml.hpp>
#include <sstream>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "cli/outputs.h"
#include "cli/run_tool.h"
#include "record/text.h"
#include "sim/sim_time.h"

namespace ispace {

namespace {

void addCase(pugi::xml_node list, const std::string& tool, const JunitCase& one) {
    pugi::xml_node test = list.append_child("testcase");
    test.append_attribute("classname") = tool.c_str();
    test.append_attribute("name") = printable(one.name).c_str();
    test.append_attribute("time") = formatMilliseconds(one.time).c_str();
    if (one.outcome == JunitCase::Outcome::Met) return;
    const bool is_error = one.outcome == JunitCase::Outcome::Error;
    pugi::xml_node failure = test.append_child(is_error ? "error" : "failure");
    failure.append_attribute("message") = printable(one.message).c_str();
    failure.append_attribute("type") = is_error ? "error" : "unmet";
}

}  // namespace

// The format has no standard; these are the elements and attributes that Jenkins, GitLab and
// GitHub's readers share: https://github.com/testmoapp/junitxml
std::string junitXml(const std::string& tool, const std::string& suite,
                     std::span<const JunitCase> cases) {
    const auto count = [cases](JunitCase::Outcome outcome) {
        return static_cast<unsigned long>(std::count_if(
            cases.begin(), cases.end(), [=](const JunitCase& c) { return c.outcome == outcome; }));
    };
    std::chrono::nanoseconds end{};
    for (const JunitCase& one : cases) end = std::max(end, one.time);

    pugi::xml_document document;
    pugi::xml_node declaration = document.append_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    declaration.append_attribute("encoding") = "UTF-8";
    pugi::xml_node root = document.append_child("testsuites");
    pugi::xml_node list = root.append_child("testsuite");
    list.append_attribute("name") = printable(suite).c_str();
    list.append_attribute("tests") = static_cast<unsigned long>(cases.size());
    list.append_attribute("failures") = count(JunitCase::Outcome::Unmet);
    list.append_attribute("errors") = count(JunitCase::Outcome::Error);
    list.append_attribute("skipped") = 0;
    list.append_attribute("time") = formatMilliseconds(end).c_str();
    for (const JunitCase& one : cases) addCase(list, tool, one);
    std::ostringstream out;
    document.save(out, "  ");
    return out.str();
}

JunitFile::JunitFile(std::string tool, const std::string& file) : tool_(std::move(tool)) {
    if (!file.empty()) file_.emplace(file);
}

void JunitFile::write(const std::string& suite, std::span<const JunitCase> cases) {
    if (!file_) return;
    file_->write(junitXml(tool_, suite, cases));
    file_->commit();
    file_.reset();
}

void JunitFile::during(std::span<const std::string> inputs, const std::function<void()>& work) {
    try {
        work();
    } catch (...) {
        JunitCase error{.name = tool_, .outcome = JunitCase::Outcome::Error};
        for (const std::string& input : inputs) error.name += ' ' + displayName(baseName(input));
        for (const std::string& line : currentFailure().lines())
            error.message.append(error.message.empty() ? "" : "; ").append(line);
        try {
            write(error.name, {&error, 1});
        } catch (const std::exception&) {  // the exception of the work is the one to report
        }
        throw;
    }
}

}  // namespace ispace
