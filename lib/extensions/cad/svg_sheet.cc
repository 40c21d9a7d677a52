// SPDX-License-Identifier: GPL-3.0-or-later
// Matches rules of style with elements. Rules are sorted by the id, class or name that their
// subject needs, so an element is compared with few; a comparison visits at most kMaxSelectorSteps
// elements, and hostile sheets are paid for in work.
#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "extensions/cad/svg.h"
#include "io/plan/drawing_source.h"

namespace ispace::cad {

namespace {

/// At-rules in each other, and selectors in selectors.
constexpr int kMaxRuleDepth = 8, kMaxSelectorDepth = 4;
/// Elements compared with one selector.
constexpr int kMaxSelectorSteps = 1000;
/// Simple selectors compared, and bytes of an attribute that are searched, in a unit of Budget.
constexpr std::size_t kStepsPerUnit = 16, kBytesPerStep = 32;

std::string withoutComments(std::string_view css) {
    std::string text;
    while (!css.empty()) {
        const std::size_t begin = css.find("/*");
        text += css.substr(0, begin);
        if (begin == std::string_view::npos) break;
        const std::size_t end = css.find("*/", begin + 2);
        css.remove_prefix(end == std::string_view::npos ? css.size() : end + 2);
    }
    return text;
}

/// Removes and returns the text before the mark, which is removed, too.
std::string_view takeUntil(std::string_view& rest, char mark) {
    const std::string_view part = rest.substr(0, rest.find(mark));
    rest.remove_prefix(std::min(part.size() + 1, rest.size()));
    return part;
}

/// Removes and returns the text before the next comma outside of parentheses, which is removed,
/// too.
std::string_view takeItem(std::string_view& rest) {
    int depth = 0;
    std::size_t end = 0;
    for (; end < rest.size(); ++end) {
        if (rest[end] == '(') ++depth;
        if (rest[end] == ')') --depth;
        if (rest[end] == ',' && depth <= 0) break;
    }
    const std::string_view item = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return item;
}

/// Returns true if rules in this text set a property that counts.
bool mentionsProperty(std::string_view css) {
    return std::any_of(
        SvgProperties::kNames.begin(), SvgProperties::kNames.end(),
        [&](std::string_view name) { return css.find(name) != std::string_view::npos; });
}

/// Removes and returns a block up to its closing brace, which is removed, too.
std::string_view takeBlock(std::string_view& rest) {
    int depth = 1;
    std::size_t end = 0;
    for (; end < rest.size(); ++end) {
        if (rest[end] == '{') ++depth;
        if (rest[end] == '}' && --depth == 0) break;
    }
    const std::string_view block = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return block;
}

bool isCssBlank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }

/// True if a list of words, separated by blanks, has this one.
bool hasWord(std::string_view list, std::string_view word) {
    while (!list.empty()) {
        std::size_t end = 0;
        while (end < list.size() && !isCssBlank(list[end])) ++end;
        if (list.substr(0, end) == word && end > 0) return true;
        list.remove_prefix(std::min(end + 1, list.size()));
    }
    return false;
}

/// Removes and returns a name at the beginning; "" for none, or for one with escapes.
std::string_view takeName(std::string_view& rest) {
    std::size_t end = 0;
    while (end < rest.size() &&
           ((rest[end] >= 'a' && rest[end] <= 'z') || (rest[end] >= 'A' && rest[end] <= 'Z') ||
            (rest[end] >= '0' && rest[end] <= '9') || rest[end] == '-' || rest[end] == '_' ||
            static_cast<unsigned char>(rest[end]) >= 0x80))
        ++end;
    const std::string_view name = rest.substr(0, end);
    rest.remove_prefix(end);
    return name;
}

pugi::xml_node parentOf(pugi::xml_node node) {
    const pugi::xml_node parent = node.parent();
    return parent.type() == pugi::node_element ? parent : pugi::xml_node();
}

pugi::xml_node elementBefore(pugi::xml_node node) {
    do node = node.previous_sibling();
    while (node && node.type() != pugi::node_element);
    return node;
}

/// True if rules for this list of media count on a screen.
bool isForScreen(std::string_view media) {
    media = trimmed(media);
    return media.empty() || media.starts_with("screen") || media.starts_with("all") ||
           media.starts_with("only screen");
}

}  // namespace

void SvgProperties::set(std::size_t key, std::string_view value, bool is_important) {
    if (value.empty() || (important_[key] && !is_important)) return;
    values_[key] = value;
    important_[key] = is_important;
}

void SvgProperties::declare(std::string_view declarations) {
    while (!declarations.empty()) {
        const std::string_view part = takeUntil(declarations, ';');
        const std::size_t colon = part.find(':');
        if (colon == std::string_view::npos) continue;
        const auto name = std::find(kNames.begin(), kNames.end(), trimmed(part.substr(0, colon)));
        if (name == kNames.end()) continue;
        std::string_view value = trimmed(part.substr(colon + 1));
        const std::size_t mark = value.find('!');
        const bool is_important = mark != std::string_view::npos &&
                                  lowerCased(trimmed(value.substr(mark + 1))) == "important";
        if (mark != std::string_view::npos && !is_important) continue;  // invalid, as in browsers
        value = trimmed(value.substr(0, mark));
        set(static_cast<std::size_t>(name - kNames.begin()), value, is_important);
    }
}

bool SvgProperties::dropVariables() {
    bool any = false;
    for (std::string_view& value : values_)
        if (value.find("var(") != std::string_view::npos) {
            value = {};
            any = true;
        }
    return any;
}

void SvgProperties::addStronger(const SvgProperties& others) {
    for (std::size_t i = 0; i < values_.size(); ++i)
        set(i, others.values_[i], others.important_[i]);
}

SvgSheet::SvgSheet(std::span<const std::string_view> styles) {
    for (const std::string_view css : styles)
        addRules(texts_.emplace_back(withoutComments(css)), 0);
    std::sort(subjects_.begin(), subjects_.end());
}

void SvgSheet::addRules(std::string_view css, int depth) {
    while (!trimmed(css).empty()) {
        const std::size_t open = css.find('{');
        std::string_view head = trimmed(css.substr(0, open));
        const std::size_t end =
            head.starts_with('@') ? css.substr(0, open).find(';') : std::string_view::npos;
        if (end != std::string_view::npos) {  // @import, @charset, @namespace
            head = trimmed(css.substr(0, end));
            if (head.starts_with("@import")) ++unread_["@import"];
            css.remove_prefix(end + 1);
            continue;
        }
        if (open == std::string_view::npos) return;
        css.remove_prefix(open + 1);
        const std::string_view block = takeBlock(css);
        if (head.starts_with("@media")) {
            if (depth < kMaxRuleDepth && isForScreen(head.substr(6))) addRules(block, depth + 1);
            continue;
        }
        if (head.starts_with("@supports") && head.find("not") == std::string_view::npos) {
            if (depth < kMaxRuleDepth) addRules(block, depth + 1);
            continue;
        }
        if (head.starts_with('@')) {  // also of fonts, pages, animations
            const bool may_count = head.starts_with("@supports") || head.starts_with("@layer") ||
                                   head.starts_with("@container") || head.starts_with("@scope");
            if (may_count && mentionsProperty(block)) ++unread_[std::string(head.substr(0, 40))];
            continue;
        }
        if (block.find('{') != std::string_view::npos) {
            if (mentionsProperty(block)) ++unread_[std::string(head.substr(0, 40)) + " { … }"];
            continue;
        }
        SvgProperties declared;
        declared.declare(block);
        if (declared.dropVariables()) ++unread_[std::string(head.substr(0, 40)) + " { var() }"];
        if (declared.isEmpty()) continue;
        blocks_.push_back(declared);
        while (!head.empty()) addRule(trimmed(takeItem(head)));
    }
}

void SvgSheet::addRule(std::string_view selector) {
    auto parsed = parse(selector);
    if (!parsed) {
        ++unread_[std::string(selector.substr(0, 40))];
        return;
    }
    Rule rule{std::move(*parsed), {}, blocks_.size() - 1};
    for (const Compound& compound : rule.selector)
        for (const Simple& part : compound.parts) {
            if (part.kind == Simple::Kind::Never) return;
            count(part, rule.specificity);
        }
    using Kind = Simple::Kind;
    Subject subject;
    for (const Simple& part : rule.selector.back().parts)
        if (part.kind == Kind::Id || (part.kind == Kind::Class && subject.kind != Kind::Id) ||
            (part.kind == Kind::Name && subject.kind == Kind::Name))
            subject = {part.kind, part.name};
    subjects_.emplace_back(subject, rules_.size());
    rules_.push_back(std::move(rule));
}

void SvgSheet::count(const Simple& part, std::array<int, 3>& specificity) {
    if (part.kind == Simple::Kind::Where) return;
    if (part.kind == Simple::Kind::Not || part.kind == Simple::Kind::Is) {
        std::array<int, 3> most{};
        for (const std::vector<Simple>& compound : part.inner) {
            std::array<int, 3> own{};
            for (const Simple& inner : compound) count(inner, own);
            most = std::max(most, own);
        }
        for (std::size_t i = 0; i < most.size(); ++i) specificity[i] += most[i];
        return;
    }
    ++specificity[part.kind == Simple::Kind::Id ? 0 : part.kind == Simple::Kind::Name ? 2 : 1];
}

/// Parses what follows a colon.
std::optional<SvgSheet::Simple> SvgSheet::parsePseudoClass(std::string_view& selector, int depth) {
    using Kind = Simple::Kind;
    constexpr std::array<std::string_view, 14> kStates{
        "hover",   "active",   "focus",       "focus-visible", "focus-within", "visited", "target",
        "checked", "disabled", "placeholder", "invalid",       "selection",    "before",  "after"};
    const bool is_part = selector.starts_with(':');  // ::before
    if (is_part) selector.remove_prefix(1);
    const std::string_view name = takeName(selector);
    if (name.empty()) return std::nullopt;
    Simple part{Kind::Never, name, {}};
    if (is_part || isOneOf(kStates, name)) return part;
    if (name == "root") part.kind = Kind::Root;
    if (name == "first-child") part.kind = Kind::First;
    if (name == "last-child") part.kind = Kind::Last;
    if (name == "not") part.kind = Kind::Not;
    if (name == "is") part.kind = Kind::Is;
    if (name == "where") part.kind = Kind::Where;
    if (part.kind == Kind::Never) return std::nullopt;
    const bool has_list = part.kind >= Kind::Not;
    if (selector.starts_with('(') != has_list) return std::nullopt;
    if (!has_list) return part;
    int open = 0;
    std::size_t end = 0;
    for (; end < selector.size(); ++end) {
        if (selector[end] == '(') ++open;
        if (selector[end] == ')' && --open == 0) break;
    }
    if (end == selector.size() || depth == kMaxSelectorDepth) return std::nullopt;
    std::string_view list = selector.substr(1, end - 1);
    selector.remove_prefix(end + 1);
    while (!list.empty()) {
        auto inner = parse(trimmed(takeItem(list)), depth + 1);
        if (!inner || inner->size() != 1) return std::nullopt;
        part.inner.push_back(std::move(inner->front().parts));
    }
    return part;
}

std::optional<std::vector<SvgSheet::Compound>> SvgSheet::parse(std::string_view selector,
                                                               int depth) {
    std::vector<Compound> compounds;
    Compound compound;
    bool has_star = false;
    while (!selector.empty()) {
        const char c = selector.front();
        if (isCssBlank(c) || c == '>' || c == '+' || c == '~') {
            char combinator = ' ';
            while (!selector.empty() &&
                   (isCssBlank(selector.front()) ||
                    std::string_view(">+~").find(selector.front()) != std::string_view::npos)) {
                if (!isCssBlank(selector.front())) {
                    if (combinator != ' ') return std::nullopt;
                    combinator = selector.front();
                }
                selector.remove_prefix(1);
            }
            if (compound.parts.empty() && !has_star) return std::nullopt;
            compounds.push_back(std::exchange(compound, Compound{{}, combinator}));
            has_star = false;
            continue;
        }
        if (c == '*') {
            has_star = true;
            selector.remove_prefix(1);
        } else if (c == '[') {
            const std::size_t end = selector.find(']');
            if (end == std::string_view::npos) return std::nullopt;
            std::string_view inner = trimmed(selector.substr(1, end - 1));
            selector.remove_prefix(end + 1);
            Simple part{Simple::Kind::Attribute, takeName(inner), {}, ' '};
            inner = trimmed(inner);
            if (part.name.empty()) return std::nullopt;
            if (!inner.empty()) {
                const std::size_t equals = inner.find('=');
                if (equals > 1) return std::nullopt;
                part.relation = inner.front();
                part.value = trimmed(inner.substr(equals + 1));
                if (part.value.size() >= 2 && part.value.front() == part.value.back() &&
                    (part.value.front() == '"' || part.value.front() == '\''))
                    part.value = part.value.substr(1, part.value.size() - 2);
                if (std::string_view("=~^$*|").find(part.relation) == std::string_view::npos)
                    return std::nullopt;
            }
            compound.parts.push_back(part);
        } else {
            const bool has_mark = c == '.' || c == '#' || c == ':';
            if (has_mark) selector.remove_prefix(1);
            if (c == ':') {
                auto part = parsePseudoClass(selector, depth);
                if (!part) return std::nullopt;
                compound.parts.push_back(std::move(*part));
                continue;
            }
            const std::string_view name = takeName(selector);
            if (name.empty()) return std::nullopt;
            if (!has_mark && !compound.parts.empty()) return std::nullopt;
            compound.parts.push_back({c == '.'   ? Simple::Kind::Class
                                      : c == '#' ? Simple::Kind::Id
                                                 : Simple::Kind::Name,
                                      name,
                                      {}});
        }
    }
    if (compound.parts.empty() && !has_star) return std::nullopt;
    compounds.push_back(std::move(compound));
    return compounds;
}

bool SvgSheet::matches(pugi::xml_node node, const std::vector<Simple>& parts, Steps& steps) {
    return std::all_of(parts.begin(), parts.end(),
                       [&](const Simple& part) { return matches(node, part, steps); });
}

bool SvgSheet::matches(pugi::xml_node node, const Simple& part, Steps& steps) {
    const auto matches_any = [&] {
        return std::any_of(part.inner.begin(), part.inner.end(),
                           [&](const auto& compound) { return matches(node, compound, steps); });
    };
    const auto value_of = [&](const char* key) {
        const std::string_view value = node.attribute(key).value();
        steps.work += value.size() / kBytesPerStep;
        return value;
    };
    ++steps.work;
    switch (part.kind) {
        case Simple::Kind::Name:
            return svgName(node) == part.name;
        case Simple::Kind::Class:
            return hasWord(value_of("class"), part.name);
        case Simple::Kind::Id:
            return value_of("id") == part.name;
        case Simple::Kind::Root:
            return !parentOf(node);
        case Simple::Kind::First:
            return !elementBefore(node);
        case Simple::Kind::Last:
            do node = node.next_sibling();
            while (node && node.type() != pugi::node_element);
            return !node;
        case Simple::Kind::Not:
            return !matches_any();
        case Simple::Kind::Is:
        case Simple::Kind::Where:
            return matches_any();
        case Simple::Kind::Never:
            return false;
        case Simple::Kind::Attribute:
            break;
    }
    const std::string key(part.name);
    if (!node.attribute(key.c_str())) return false;
    const std::string_view value = value_of(key.c_str());
    switch (part.relation) {
        case '=':
            return value == part.value;
        case '~':
            return hasWord(value, part.value);
        case '^':
            return !part.value.empty() && value.starts_with(part.value);
        case '$':
            return !part.value.empty() && value.ends_with(part.value);
        case '*':
            return !part.value.empty() && value.find(part.value) != std::string_view::npos;
        case '|':
            return value == part.value || value.starts_with(std::string(part.value) + '-');
        default:
            return true;
    }
}

/// Matches the compounds up to `last` against the node and those around it, backtracking.
bool SvgSheet::matches(pugi::xml_node node, const std::vector<Compound>& selector, std::size_t last,
                       Steps& steps) {
    if (--steps.elements < 0 || !node || !matches(node, selector[last].parts, steps)) return false;
    if (last == 0) return true;
    const char combinator = selector[last].combinator;
    const bool is_upward = combinator == ' ' || combinator == '>';
    const bool is_direct = combinator == '>' || combinator == '+';
    for (node = is_upward ? parentOf(node) : elementBefore(node); node && steps.elements >= 0;
         node = is_upward ? parentOf(node) : elementBefore(node)) {
        if (matches(node, selector, last - 1, steps)) return true;
        if (is_direct) return false;
    }
    return false;
}

std::size_t SvgSheet::apply(pugi::xml_node node, SvgProperties& properties) const {
    if (rules_.empty()) return 0;
    std::vector<std::size_t> found;
    Steps steps;
    const auto collect = [&](Simple::Kind kind, std::string_view name) {
        const Subject subject{kind, name};
        for (auto own = std::lower_bound(subjects_.begin(), subjects_.end(),
                                         std::pair(subject, std::size_t{0}));
             own != subjects_.end() && own->first == subject; ++own) {
            const Rule& rule = rules_[own->second];
            steps.elements = kMaxSelectorSteps;
            ++steps.work;
            if (matches(node, rule.selector, rule.selector.size() - 1, steps))
                found.push_back(own->second);
        }
    };
    collect(Simple::Kind::Name, "");
    collect(Simple::Kind::Name, svgName(node));
    if (const pugi::xml_attribute id = node.attribute("id")) collect(Simple::Kind::Id, id.value());
    std::string_view classes = node.attribute("class").value();
    steps.work += classes.size() / kBytesPerStep;
    std::vector<std::string_view> names;
    while (!classes.empty()) {
        std::size_t end = 0;
        while (end < classes.size() && !isCssBlank(classes[end])) ++end;
        if (end > 0) names.push_back(classes.substr(0, end));
        classes.remove_prefix(std::min(end + 1, classes.size()));
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    for (const std::string_view name : names) collect(Simple::Kind::Class, name);
    std::sort(found.begin(), found.end(), [this](std::size_t a, std::size_t b) {
        return std::pair(rules_[a].specificity, a) < std::pair(rules_[b].specificity, b);
    });
    SvgProperties all;
    for (const std::size_t i : found) all.addStronger(blocks_[rules_[i].block]);
    all.addStronger(properties);
    properties = all;
    return (steps.work + found.size()) / kStepsPerUnit;
}

}  // namespace ispace::cad
