// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/yaml.h"

#include <utility>

#include "base/utf8.h"
#include "record/lexer.h"
#include "record/written_ids.h"
#include "record/yaml_expand.h"
#include "record/yaml_magic.h"
#include "record/yaml_reader.h"

namespace ispace {

namespace {

/// Kind and history behind a magic first line, if there is one.
Document readHead(std::string_view bytes, const std::string& name) {
    Document document;
    LineReader lines(withoutMark(bytes));
    const auto first = lines.next();
    if (!first || !first->starts_with(kYamlMagic)) return document;
    const std::string_view version = first->substr(kYamlMagic.size());
    if (version == kYamlLayoutVersion) {
        document.kind = DocumentKind::Layout;
    } else if (version != kYamlVersion) {
        throw FormatError({name, 1, static_cast<int>(kYamlMagic.size()) + 1,
                           "version " + excerpt(version) +
                               " found, wanted `# ispace yaml 1` or `# ispace yaml 1 layout`"});
    }
    for (auto line = lines.next(); line && line->starts_with("# "); line = lines.next())
        document.history.emplace_back(line->substr(2));
    return document;
}

}  // namespace

Document readYaml(std::string_view bytes, const std::string& name, const Schemas& schemas,
                  const FileReader& read) {
    RecordCollector collector(name, schemas);
    YamlReader reader(collector, name, read);
    YamlScene scene = reader.read(bytes);
    Document document = readHead(bytes, name);
    document.records = expandItems(std::move(scene), collector);
    document.sources = reader.files();
    findDoubledIds(document.records, collector.findings());
    collector.findings().throwIfAny();
    return document;
}

}  // namespace ispace
