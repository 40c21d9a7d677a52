// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/extensions.h"

#include <algorithm>

#include "io/exporters.h"
#include "io/importers.h"
#include "record/missing_keywords.h"
#include "sim/script_lines.h"

namespace ispace {

Extensions::Extensions(std::span<const Extension> built, std::span<const MissingOffer> missing) {
    for (const Extension& each : built) {
        names_.push_back(each.name);
        for (const ToolOptions& row : each.options)
            options_.push_back({each.name, row.tool, row.make});
        for (const auto make : each.objectives) objectives_.push_back({each.name, make});
        if (each.arrange != nullptr) arrange_.push_back({each.name, each.arrange});
        if (each.coverage != nullptr) coverage_.push_back({each.name, each.coverage});
        if (each.import != nullptr) imports_.push_back({each.name, each.import});
        if (each.record != nullptr) records_.push_back({each.name, each.record});
        if (each.report != nullptr) reports_.push_back({each.name, each.report});
        if (each.drawing != nullptr) drawings_.push_back({each.name, each.drawing});
        if (each.proof != nullptr) proofs_.push_back({each.name, each.proof});
        if (each.judge != nullptr) judges_.push_back(each.judge);
        if (each.bridge != nullptr) bridges_.push_back({each.name, each.bridge});
        if (each.role != nullptr) roles_.push_back(each.role);
        if (each.buildings.open != nullptr) {
            buildings_ = each.buildings;
            buildings_.extension = each.name;
        }
        if (each.add != nullptr) each.add();
    }
    std::sort(names_.begin(), names_.end());
    for (const auto& [extension, owner, name] : missing) {
        if (owner == "record")
            addMissingKeyword(name, extension);
        else if (owner == "format")
            addMissingFormat(name, extension);
        else if (owner == "line")
            addMissingScriptLine(name, extension);
        else if (owner == "export")
            addMissingExporter(name, extension);
        else if (owner == "requirement")
            coverage_.push_back({extension, nullptr, name});
        else if (owner == "report")
            reports_.push_back({extension, nullptr, name});
        else if (owner == "drawing")
            drawings_.push_back({extension, nullptr, name});
        else if (owner == "objective")
            objectives_.push_back({extension, nullptr, name});
        else if (owner == "run")
            buildings_.extension = extension;
        else if (owner == "proof")
            proofs_.push_back({extension, nullptr, name});
        else
            options_.push_back({extension, owner, nullptr, name});
    }
}

}  // namespace ispace
