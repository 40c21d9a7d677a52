// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "record/record.h"

namespace ispace {

/// Written ids seen so far, and where.
class IdTable {
  public:
    /// Adds the record's id, if it has one. \return what is wrong if another record has it
    std::optional<Diagnostic> add(const Record& record);

  private:
    std::map<std::string, Place> places_;
};

/// Makes checked records of keywords, keys and values, and collects what is wrong with them: what
/// the readers of text and of YAML have in common.
///
///     if (collector.begin("desk", place)) {
///         if (const KeySpec* key = collector.key("height", place)) collector.text(*key, "5cm",
///         place); collector.end();
///     }
class RecordCollector {
  public:
    RecordCollector(const std::string& name, const Schemas& schemas)
        : file_(std::make_shared<const std::string>(name)), schemas_(&schemas) {}

    [[nodiscard]] Place place(int line, int column) const { return {file_, line, column}; }

    /// Starts a record. False if there is no such keyword, which becomes a finding.
    bool begin(std::string_view keyword, const Place& place);
    /// The key of the record begun; null, and a finding, if it is unknown or there for the second
    /// time.
    const KeySpec* key(std::string_view name, const Place& place);
    /// Sets a key from its text, or from its value.
    void text(const KeySpec& key, std::string_view text, const Place& place);
    void value(const KeySpec& key, Value value, const Place& place);
    /// Ends the record: keys it must have, ids. It is kept only if nothing is wrong with it.
    void end();

    /// Adds a finding. `message` is a function that makes its text, called only if it is kept:
    /// hints cost time, and a hostile file has many errors.
    template <typename Message>
    void finding(const Place& place, Message message) {
        sound_ = false;
        findings_.add(findings_.full() ? Diagnostic{} : place.finding(message()));
    }

    /// The records, in order. \throws FormatError with all findings if there are any
    std::vector<Record> take();

  private:
    std::shared_ptr<const std::string> file_;
    const Schemas* schemas_;
    Diagnostics findings_;
    IdTable ids_;
    std::vector<Record> records_;
    std::vector<Place> seen_;  // of the current record, by index of the key; no file: not seen
    std::optional<Record> current_;
    bool sound_ = true;  // nothing wrong with the current record so far
};

}  // namespace ispace
