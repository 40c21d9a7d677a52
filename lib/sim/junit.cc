// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <pugixml.hpp>
#include <sstream>

#include "base/message.h"
#include "sim/expect.h"

namespace ispace {

// The format has no standard; these are the elements and attributes that Jenkins, GitLab and
// GitHub's readers share: https://github.com/testmoapp/junitxml
std::string junitXml(const std::vector<RunVerdict>& verdicts, const std::string& suite) {
    const auto failures = std::count_if(verdicts.begin(), verdicts.end(),
                                        [](const RunVerdict& v) { return !v.is_met; });
    SimTime end{};
    for (const RunVerdict& verdict : verdicts) end = std::max(end, verdict.time);

    pugi::xml_document document;
    pugi::xml_node declaration = document.append_child(pugi::node_declaration);
    declaration.append_attribute("version") = "1.0";
    declaration.append_attribute("encoding") = "UTF-8";
    pugi::xml_node root = document.append_child("testsuites");
    pugi::xml_node list = root.append_child("testsuite");
    list.append_attribute("name") = printable(suite).c_str();
    list.append_attribute("tests") = static_cast<unsigned long>(verdicts.size());
    list.append_attribute("failures") = static_cast<unsigned long>(failures);
    list.append_attribute("errors") = 0;
    list.append_attribute("skipped") = 0;
    list.append_attribute("time") = formatMilliseconds(end).c_str();
    for (const RunVerdict& verdict : verdicts) {
        pugi::xml_node test = list.append_child("testcase");
        test.append_attribute("classname") = "simrun";
        test.append_attribute("name") = printable(verdict.expectation).c_str();
        test.append_attribute("time") = formatMilliseconds(verdict.time).c_str();
        if (verdict.is_met) continue;
        pugi::xml_node failure = test.append_child("failure");
        failure.append_attribute("message") = printable(verdict.reason).c_str();
        failure.append_attribute("type") = "unmet";
    }
    std::ostringstream out;
    document.save(out, "  ");
    return out.str();
}

}  // namespace ispace
