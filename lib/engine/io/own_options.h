// SPDX-License-Identifier: GPL-3.0-or-later
// Options that belong to extensions, in the middle of those of the core, which carries them without
// knowledge of their types.
//
//     struct AriaPoints { bool are_obstacles = false; };       // in the folder of the extension
//     options.own.edit<AriaPoints>().are_obstacles = true;     // where the command line is read
//     if (options.own.get<AriaPoints>().are_obstacles) ...     // in its importer
#pragma once

#include <any>
#include <map>
#include <typeindex>

namespace ispace {

/// One value of each type. Reading is thread-safe; each access is a search by type.
class OwnOptions {
  public:
    /// Returns the value of a type, as it was made if none was set.
    template <class T>
    [[nodiscard]] const T& get() const {
        static const T made{};
        const auto found = values_.find(typeid(T));
        return found == values_.end() ? made : *std::any_cast<T>(&found->second);
    }
    /// Returns the value of a type for changes.
    template <class T>
    T& edit() {
        std::any& value = values_[typeid(T)];
        if (!value.has_value()) value = T{};
        return *std::any_cast<T>(&value);
    }

  private:
    std::map<std::type_index, std::any> values_;
};

}  // namespace ispace
