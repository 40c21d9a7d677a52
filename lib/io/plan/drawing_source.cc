// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan/drawing_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/glob.h"
#include "base/message.h"
#include "base/number.h"
#include "env/environment.h"

namespace ispace {

namespace {

/// Width of a plan in metres if its unit is right.
constexpr double kLikelyPlan = 3, kUnlikelyPlan = 300;

/// Metres; drawings outside have another unit than they say.
constexpr double kMinDrawing = 1, kMaxDrawing = 2000;

/// Rooms with areas that differ by a smaller share count as the same.
constexpr double kSameRoom = 0.01;

/// Square metres; smaller rooms are no advice.
constexpr double kLeastRoom = 1;

/// Drawings with more lines of walls are not read again for a message.
constexpr std::size_t kMaxLinesReadAgain = 100'000;

constexpr std::array<std::string_view, 63> kWallWords{
    "wall",   "walls",   "wand",   "wände", "waende", "wande",  "mauer",    "mauern", "mauerwerk",
    "mur",    "murs",    "mura",   "mury",  "muro",   "muros",  "muri",     "muur",   "muren",
    "parede", "paredes", "pared",  "paret", "parets", "parete", "pareti",   "perete", "pereți",
    "pereti", "vägg",    "väggar", "vegg",  "vegger", "væg",    "vægge",    "seinä",  "seinät",
    "stěna",  "stěny",   "stena",  "steny", "zed",    "zdi",    "zid",      "zidovi", "ściana",
    "ściany", "sciana",  "sciany", "fal",   "falak",  "duvar",  "duvarlar", "τοίχος", "τοίχοι",
    "стена",  "стены",   "стіна",  "стіни", "墙",     "墙体",   "壁",       "벽",     "벽체"};
/// Word endings, as in Innenwand and CURTAINWALL.
constexpr std::array<std::string_view, 6> kWallEnds{"wall",  "walls",  "wand",
                                                    "wände", "waende", "mauer"};
/// Words of layers that belong to walls but have no outlines of walls.
constexpr std::array<std::string_view, 20> kOtherWords{
    "patt",  "hatch", "hatching", "fill",    "schraffur", "iden",     "text",
    "texts", "tag",   "tags",     "dim",     "dims",      "note",     "notes",
    "door",  "doors", "window",   "windows", "glaz",      "furniture"};

/// Beginnings of words of layers without walls, in lower case: furniture, dimensions, text,
/// hatching, axes, electrical, plumbing.
constexpr std::array<std::string_view, 186> kNoWallStems{
    "furnit",   "möbel",     "moebel",        "mobel",    "mobil",       "mobler",   "möbler",
    "møbl",     "meubel",    "meubil",        "meubl",    "mebl",        "mööbel",   "mēbel",
    "kalust",   "huonekal",  "nábyt",         "nabyt",    "bútor",       "butor",    "namješ",
    "namjes",   "namešt",    "namest",        "pohiš",    "baldai",      "mobilya",  "έπιπλ",
    "επιπλ",    "мебел",     "мебл",          "обзавежд", "家具",        "가구",     "dimens",
    "bemass",   "bemaß",     "vermass",       "vermaß",   "cotas",       "cotat",    "cotac",
    "acotac",   "acotad",    "maatv",         "maatl",    "mitoit",      "wymiar",   "ölçü",
    "olcu",     "mérete",    "meretez",       "kótov",    "kotov",       "размер",   "розмір",
    "διαστάσ",  "διαστασ",   "尺寸",          "标注",     "標注",        "寸法",     "치수",
    "annot",    "beschrift", "textos",        "texto",    "testi",       "tekst",    "szöveg",
    "szoveg",   "metin",     "teksti",        "текст",    "надпис",      "κείμεν",   "κειμεν",
    "文字",     "文本",      "注释",          "문자",     "schriftfeld", "plankopf", "cartigl",
    "cartouch", "legend",    "titlebl",       "rotulo",   "rótulo",      "tytuł",    "hatch",
    "schraff",  "hachur",    "sombread",      "trattegg", "tratteg",     "retino",   "arcer",
    "skraver",  "šraf",      "sraf",          "kreskow",  "tarama",      "rayado",   "rellen",
    "штрих",    "заливк",    "填充",          "해치",     "achs",        "eixos",    "axlar",
    "tengely",  "osie",      "osy",           "axen",     "akslinj",     "akselij",  "axonum",
    "осеве",    "осевы",     "координационн", "轴线",     "轴网",        "轴号",     "軸線",
    "통심",     "gridlin",   "elect",         "elekt",    "elett",       "eléct",    "élect",
    "eletr",    "elett",     "sähkö",         "sahko",    "villany",     "elektrik", "электр",
    "електр",   "ηλεκτρ",    "电气",          "電気",     "전기",        "照明",     "beleucht",
    "leucht",   "steckdos",  "enchuf",        "lumin",    "belysn",      "освещ",    "освітл",
    "plumb",    "sanitär",   "sanitaer",      "sanitar",  "sanitair",    "sanear",   "fontan",
    "plombe",   "idraul",    "hidraul",       "hydraul",  "saniteh",     "rohrl",    "vodovod",
    "kanaliz",  "vízvez",    "tesisat",       "сантех",   "водопр",      "канализ",  "υδραυλ",
    "给排水",   "給排水",    "卫生",          "洁具",     "衛生",        "위생",     "hvac",
    "lüftung",  "lueftung",  "heizung",       "klima"};
/// The same as whole words, which begin others.
constexpr std::array<std::string_view, 83> kNoWallWords{
    "furn",        "furniture", "equip",  "appl",   "muebles", "mueble", "arredi",  "arredo",
    "arredamento", "móveis",    "moveis", "mobili", "meble",   "dim",    "dims",    "dimen",
    "cote",        "cotes",     "cota",   "quote",  "maße",    "mått",   "mål",     "mitat",
    "kóty",        "koty",      "kote",   "kota",   "méret",   "meret",  "text",    "texts",
    "texte",       "textes",    "testo",  "anno",   "note",    "notes",  "tag",     "tags",
    "iden",        "txt",       "tekste", "patt",   "pattern", "trama",  "mønster", "schraf",
    "axis",        "axes",      "axe",    "asse",   "assi",    "eje",    "ejes",    "eixo",
    "akse",        "akser",     "osi",    "aks",    "оси",     "ось",    "осі",     "grid",
    "grids",       "raster",    "achse",  "achsen", "elec",    "lite",   "light",   "lights",
    "licht",       "luce",      "luces",  "luci",   "fixt",    "pipe",   "pipes",   "piping",
    "vvs",         "sani",      "wc"};

/// Splits a name into words in lower case: letters of ASCII, and all characters beyond ASCII.
std::vector<std::string> wordsOf(std::string_view name) {
    std::vector<std::string> words;
    bool inside = false;
    for (const char c : lowerCased(name)) {
        const bool is_letter = (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80;
        if (is_letter && !inside) words.emplace_back();
        inside = is_letter;
        if (is_letter) words.back() += c;
    }
    return words;
}

/// As an option takes it in a shell, its glob characters escaped.
std::string optionText(const std::string& name) {
    std::string glob;
    bool is_plain = true;
    for (const char c : name) {
        const bool is_glob = std::string_view("*?[]\\").find(c) != std::string_view::npos;
        if (is_glob) glob += '\\';
        glob += c;
        is_plain = is_plain && !is_glob &&
                   (std::isalnum(static_cast<unsigned char>(c)) != 0 ||
                    static_cast<unsigned char>(c) >= 0x80 ||
                    std::string_view("-_.").find(c) != std::string_view::npos);
    }
    return is_plain ? glob : '\'' + glob + '\'';
}

}  // namespace

std::string lowerCased(std::string_view text) {
    const auto lower = [](unsigned code) {
        const bool is_even_upper =
            (code >= 0x100 && code < 0x138) || (code >= 0x14A && code < 0x178);
        const bool is_odd_upper =
            (code >= 0x139 && code < 0x149) || (code >= 0x179 && code < 0x17F);
        if ((code >= 0xC0 && code <= 0xDE && code != 0xD7) || (code >= 0x391 && code <= 0x3A9) ||
            (code >= 0x410 && code <= 0x42F))
            return code + 0x20;
        if (code >= 0x400 && code <= 0x40F) return code + 0x50;
        return (is_even_upper && code % 2 == 0) || (is_odd_upper && code % 2 == 1) ? code + 1
                                                                                   : code;
    };
    std::string result(text);
    for (std::size_t i = 0; i < result.size(); ++i) {
        char& c = result[i];
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
        if (utf8Length(std::string_view(result).substr(i)) != 2) continue;
        const auto lead = static_cast<unsigned char>(c),
                   trail = static_cast<unsigned char>(result[i + 1]);
        const unsigned code = lower((lead & 0x1FU) << 6U | (trail & 0x3FU));
        c = static_cast<char>(0xC0U | code >> 6U);
        result[++i] = static_cast<char>(0x80U | (code & 0x3FU));
    }
    return result;
}

std::string unitText(double metres_per_unit) {
    return "a unit of the drawing is " + formatDouble(std::round(metres_per_unit * 1e9) / 1e6) +
           " mm";
}

double metresPerUnit(double width, const std::string& name,
                     const std::function<std::vector<PlanPath>(double)>& read) {
    // Curves are drawn to a millimetre: the second round measures them at nearly the right scale.
    double scale = 0.001;
    for (int round = 0; round < 2; ++round) {
        Box2 box;
        for (const PlanPath& path : read(scale))
            for (const Point2 p : path.points) box.add(p);
        if (!(box.width() > 0))
            failFile(name, "the lines of walls have no width: --width-is needs some");
        scale *= width / box.width();
    }
    return scale;
}

std::string otherUnitHint(double extent, const DrawingSource& drawing,
                          const ImportOptions& options) {
    if (!drawing.area) return "";
    for (const char* name : {"m", "mm", "cm", "inch", "foot"}) {
        const auto other =
            std::find_if(kLengthUnits.begin(), kLengthUnits.end(),
                         [&](const LengthUnit& u) { return std::string_view(u.name) == name; });
        const double metres = extent / drawing.metres_per_unit * other->metres;
        if (metres < kLikelyPlan || metres > kUnlikelyPlan) continue;
        ImportOptions as_other = options;
        as_other.units = name;
        as_other.width_is.reset();
        as_other.found = nullptr;
        return " It is read in " + drawing.unit + "; with --units " + name + " it would be " +
               lengthText(metres) + " m wide and have " + areaText(drawing.area(as_other)) +
               " of floor";
    }
    return "";
}

void checkScale(double extent, const DrawingSource& drawing, const std::string& name,
                const ImportOptions& options) {
    if (!options.units.empty() || options.width_is) return;
    if (extent >= kMinDrawing && extent <= kMaxDrawing) return;
    const std::string hint = otherUnitHint(extent, drawing, options);
    const std::string metres = extent < kMaxDrawing ? lengthText(extent) : formatFixed(extent, 0);
    failFile(name, "the plan is " + metres + " m wide: is its unit right?" +
                       (hint.empty() ? " Else " + std::string(kScaleHint)
                                     : hint + "; or say how wide it is, with --width-is 8.3m"));
}

bool matchesLayer(const std::vector<std::string>& globs, std::string_view layer) {
    const std::string name = lowerCased(layer);
    return std::any_of(globs.begin(), globs.end(), [&](const std::string& glob) {
        return Glob(lowerCased(glob)).matches(name);
    });
}

bool isWallName(std::string_view name) {
    const std::vector<std::string> words = wordsOf(name);
    if (std::any_of(words.begin(), words.end(),
                    [](const std::string& word) { return isOneOf(kOtherWords, word); }))
        return false;
    return std::any_of(words.begin(), words.end(), [](const std::string& word) {
        return isOneOf(kWallWords, word) ||
               std::any_of(kWallEnds.begin(), kWallEnds.end(),
                           [&](std::string_view end) { return word.ends_with(end); });
    });
}

bool isNoWallName(std::string_view name) {
    if (isWallName(name)) return false;
    const std::vector<std::string> words = wordsOf(name);
    return std::any_of(words.begin(), words.end(), [](const std::string& word) {
        return isOneOf(kNoWallWords, word) ||
               std::any_of(kNoWallStems.begin(), kNoWallStems.end(),
                           [&](std::string_view stem) { return word.starts_with(stem); });
    });
}

void warnOfWallNames(const std::map<std::string, std::size_t>& names, double area,
                     const DrawingSource& drawing, const ImportOptions& options,
                     ImportRecords& out) {
    if (names.empty() || !drawing.area) return;
    std::string hint;
    std::size_t lines = 0;
    ImportOptions from_walls = options;
    from_walls.found = nullptr;
    for (const auto& [name, count] : names) {
        const std::string text = optionText(name);
        hint += " --wall-layer " + text;
        from_walls.wall_layers.push_back(text.front() == '\'' ? text.substr(1, text.size() - 2)
                                                              : text);
        lines += count;
    }
    if (lines > kMaxLinesReadAgain)
        return out.warn("the drawing names its walls, which were not taken alone: try" + hint);
    try {
        const double other = drawing.area(from_walls);
        if (other < kLeastRoom) return;
        if (drawing.better_layers != nullptr && other > (1 + kSameRoom) * area) {
            *drawing.better_layers = from_walls.wall_layers;
            return;
        }
        if (std::abs(other - area) > kSameRoom * std::max(other, area))
            out.warn("the drawing names its walls: with" + hint + " it would have " +
                     areaText(other) + " of floor, not " + areaText(area));
    } catch (const FormatError& /*those layers are no plan*/) {
        return;
    }
}

Document importWithNamedWalls(
    const ImportOptions& options,
    const std::function<Document(const ImportOptions&, std::vector<std::string>*)>& import) {
    std::vector<std::string> better;
    ImportReport report;
    FoundRooms rooms;
    if (options.report != nullptr) report = *options.report;
    if (options.found != nullptr) rooms = *options.found;
    Document document;
    if (!options.inside.empty()) {
        // A drawing has one reading of its layers, whichever of its rooms is kept.
        ImportOptions largest = options;
        largest.inside.clear();
        largest.found = nullptr;
        largest.report = nullptr;
        try {
            import(largest, &better);
        } catch (const FormatError& /*no room by default*/) {
            better.clear();
        }
        if (better.empty()) return import(options, nullptr);
    } else {
        document = import(options, &better);
        if (better.empty()) return document;
    }
    if (options.report != nullptr) *options.report = std::move(report);
    if (options.found != nullptr) *options.found = std::move(rooms);
    ImportOptions walls = options;
    walls.wall_layers = better;
    document = import(walls, nullptr);
    std::string text = "only lines named as walls are taken, the others clutter their room:";
    for (const std::string& layer : better) text += " --wall-layer " + optionText(layer);
    text += "; --wall-layer '*' takes all";
    const std::string file =
        document.records.empty() || document.records.front().place().file == nullptr
            ? ""
            : *document.records.front().place().file;
    if (options.report != nullptr)
        options.report->addChoice(file, text);
    else
        document.notes.push_back(text);
    return document;
}

}  // namespace ispace
