// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "record/record.h"

namespace ispace {

/// "line 3", with the file's name where that is not the file of `here`.
std::string otherPlace(const Place& other, const Place& here);

/// ", did you mean …?" with the nearest of the known words, or ", known: " and all of them.
std::string knownWords(std::string_view word, const std::vector<std::string>& known);

/// Builds checked records from keywords, keys and values and collects errors: the common part of
/// the readers of text and of YAML.
///
///     if (collector.begin("desk", spot)) {
///         if (const KeySpec* key = collector.key("height", spot)) collector.text(*key, "5cm",
///         spot); collector.end();
///     }
class RecordCollector {
  public:
    /// Most records of one input: some gigabytes.
    static constexpr std::size_t kMaxRecords = 1'000'000;

    RecordCollector(const std::string& name, const Schemas& schemas)
        : file_{std::make_shared<const std::string>(name)}, schemas_(&schemas) {}

    /// Sets the file of what follows; the line and column of `file` do not count.
    void setFile(Place file) { file_ = std::move(file); }
    [[nodiscard]] const Place& file() const { return file_; }
    [[nodiscard]] const Schemas& schemas() const { return *schemas_; }

    /// Starts a record. False, and a finding, if the keyword is unknown.
    /// \param keys how many it seems to give
    bool begin(std::string_view keyword, Spot spot, std::size_t keys = 0);
    void begin(const Schema& schema, Spot spot, std::size_t keys = 0);
    /// A key of the current record; null, and a finding, if it is unknown or doubled.
    const KeySpec* key(std::string_view name, Spot spot);
    /// True if the current record gives the key, even with its default or a bad value.
    [[nodiscard]] bool isGiven(const KeySpec& key) const;
    /// Sets a key from its text.
    void text(const KeySpec& key, std::string_view text, Spot spot);
    /// Sets a key. \pre the value is good
    void value(const KeySpec& key, Value value, Spot spot);
    /// Ends the record and checks that required keys are there. \return it, even with findings
    Record finish();
    /// finish(), and keeps the record. \throws FormatError for more than kMaxRecords
    void end();

    /// Takes the records of another that read what follows, which has no findings.
    /// \throws FormatError as end() does
    void append(RecordCollector&& next);

    /// Adds a finding. `message` is a function that makes its text, called only if the finding is
    /// kept: hints take time, and a hostile file has many errors.
    template <typename Message>
    void finding(const Place& place, Message message) {
        findings_.add(findings_.full() ? Diagnostic{} : place.finding(message()));
    }
    template <typename Message>
    void finding(Spot spot, Message message) {
        finding(file_.at(spot), std::move(message));
    }
    void add(const FormatError& error) { findings_.add(error); }
    [[nodiscard]] Diagnostics& findings() { return findings_; }

    /// The records, in order. \throws FormatError with all findings, those of doubled ids last
    std::vector<Record> take();

  private:
    void checkCount() const;

    Place file_;
    const Schemas* schemas_;
    Diagnostics findings_;
    std::vector<Record> records_;  // also those with findings
    std::vector<Spot> seen_;       // keys of the current record, by their index; line 0: not seen
    std::optional<Record> current_;
};

}  // namespace ispace
