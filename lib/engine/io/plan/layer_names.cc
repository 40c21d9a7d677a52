// SPDX-License-Identifier: GPL-3.0-or-later
// Words by which drawings name layers, blocks and groups. Sources: United States National CAD
// Standard (AIA CAD Layer Guidelines), ISO 13567-2 with the tables of CI/SfB, BS 1192, and layers
// of public drawings in two dozen languages. Words match whole, by their beginnings, or by their
// endings where a language joins words; parts within a word count only in scripts without blanks.
#include "io/plan/layer_names.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/glob.h"
#include "base/message.h"

namespace ispace {

namespace {

constexpr auto kWallWords = std::to_array<std::string_view>(
    {"wall",       "walls",      "wand",      "wände",    "waende",   "wande",       "mauer",
     "mauern",     "mauerwerk",  "mur",       "murs",     "mura",     "mury",        "muro",
     "muros",      "muri",       "muur",      "muren",    "parede",   "paredes",     "pared",
     "paret",      "parets",     "parete",    "pareti",   "perete",   "pereți",      "pereti",
     "vägg",       "väggar",     "vegg",      "vegger",   "væg",      "vægge",       "seinä",
     "seinät",     "stěna",      "stěny",     "stena",    "steny",    "zed",         "zdi",
     "zid",        "zidovi",     "ściana",    "ściany",   "sciana",   "sciany",      "fal",
     "falak",      "duvar",      "duvarlar",  "τοίχος",   "τοίχοι",   "стена",       "стены",
     "стіна",      "стіни",      "стени",     "стен",     "стін",     "перегородка", "перегородки",
     "зид",        "зидови",     "қабырға",   "պատ",      "պատեր",    "კედელი",      "კედლები",
     "partition",  "partitions", "prtn",      "cloison",  "cloisons", "tabique",     "tabiques",
     "tabiqueria", "tabiquería", "alvenaria", "tramezzi", "tramezzo", "muratura",    "murature",
     "zdivo",      "příčka",     "příčky",    "pricky",   "ziduri",   "falazat",     "válaszfal",
     "horma",      "hormak",     "veggur",    "veggir",   "sein",     "seinad",      "siena",
     "sienas",     "sienos",     "dinding",   "tembok",   "tường",    "ukuta",       "tuong",
     "جدار",       "جدران",      "حائط",      "حوائط",    "الجدران",  "الحوائط",     "دیوار",
     "دیوارها",    "קיר",        "קירות",     "दीवार",    "दीवारें",    "দেয়াল",       "சுவர்",
     "ผนัง",        "กำแพง",      "壁",        "間仕切",   "間仕切り", "隔断",        "벽",
     "벽체",       "가벽"});
/// Word endings, as in Innenwand and CURTAINWALL.
constexpr auto kWallEnds = std::to_array<std::string_view>(
    {"wall", "walls", "wand", "wände", "waende", "mauer", "vägg", "väggar", "vegg", "vegger", "væg",
     "vægge", "seinä", "seinät", "muur", "muren"});
/// Parts of words without blanks between them, as in 外墙 and 承重牆体.
constexpr auto kWallParts =
    std::to_array<std::string_view>({"墙", "墻", "牆", "외벽", "내벽", "조적벽", "옹벽", "칸막이",
                                     "外壁", "内壁", "壁体", "耐力壁"});
/// Words of fillings, texts, openings, furniture and papers, of which such parts are no walls.
constexpr auto kOtherParts = std::to_array<std::string_view>(
    {"填充", "标注", "標注", "尺寸", "文字", "注释", "轴",  "軸", "门",
     "門",   "窗",   "家具", "柜",   "櫃",   "纸",   "紙",  "漆", "裙",
     "灯",   "燈",   "치수", "문자", "해치", "寸法", "仕上"});
/// Ends of compound words of layers without walls, as in Wandschraffur.
constexpr auto kNoWallEnds = std::to_array<std::string_view>(
    {"schraffur", "schraffuren", "hatch", "hatching", "hachure", "hachures", "text", "texte",
     "texts", "fliesen", "bemassung", "bemaßung", "beschriftung", "arcering"});
/// Words of layers that belong to walls but have no outlines of walls.
constexpr auto kOtherWords = std::to_array<std::string_view>(
    {"hachure", "hachures", "textes",  "patt", "hatch",     "hatching", "fill", "schraffur", "iden",
     "text",    "texts",    "tag",     "tags", "dim",       "dims",     "note", "notes",     "door",
     "doors",   "window",   "windows", "glaz", "furniture", "填充",     "标注", "標注",      "尺寸",
     "寸法",    "해치",     "치수",    "문자", "штриховка", "заливка"});

/// Beginnings of words of layers without walls, in lower case: furniture, dimensions, text,
/// hatching, axes, electrical, plumbing.
constexpr auto kNoWallStems = std::to_array<std::string_view>({"furnit",
                                                               "möbel",
                                                               "moebel",
                                                               "mobel",
                                                               "mobil",
                                                               "mobler",
                                                               "möbler",
                                                               "møbl",
                                                               "meubel",
                                                               "meubil",
                                                               "meubl",
                                                               "mebl",
                                                               "mööbel",
                                                               "mēbel",
                                                               "kalust",
                                                               "huonekal",
                                                               "nábyt",
                                                               "nabyt",
                                                               "bútor",
                                                               "butor",
                                                               "namješ",
                                                               "namjes",
                                                               "namešt",
                                                               "namest",
                                                               "pohiš",
                                                               "baldai",
                                                               "mobilya",
                                                               "έπιπλ",
                                                               "επιπλ",
                                                               "мебел",
                                                               "мебл",
                                                               "обзавежд",
                                                               "家具",
                                                               "가구",
                                                               "dimens",
                                                               "bemass",
                                                               "bemaß",
                                                               "vermass",
                                                               "vermaß",
                                                               "cotas",
                                                               "cotat",
                                                               "cotac",
                                                               "acotac",
                                                               "acotad",
                                                               "maatv",
                                                               "maatl",
                                                               "mitoit",
                                                               "wymiar",
                                                               "ölçü",
                                                               "olcu",
                                                               "mérete",
                                                               "meretez",
                                                               "kótov",
                                                               "kotov",
                                                               "размер",
                                                               "розмір",
                                                               "διαστάσ",
                                                               "διαστασ",
                                                               "尺寸",
                                                               "标注",
                                                               "標注",
                                                               "寸法",
                                                               "치수",
                                                               "annot",
                                                               "beschrift",
                                                               "textos",
                                                               "texto",
                                                               "testi",
                                                               "tekst",
                                                               "szöveg",
                                                               "szoveg",
                                                               "metin",
                                                               "teksti",
                                                               "текст",
                                                               "надпис",
                                                               "κείμεν",
                                                               "κειμεν",
                                                               "文字",
                                                               "文本",
                                                               "注释",
                                                               "문자",
                                                               "schriftfeld",
                                                               "plankopf",
                                                               "cartigl",
                                                               "cartouch",
                                                               "legend",
                                                               "titlebl",
                                                               "rotulo",
                                                               "rótulo",
                                                               "tytuł",
                                                               "hatch",
                                                               "schraff",
                                                               "hachur",
                                                               "sombread",
                                                               "trattegg",
                                                               "tratteg",
                                                               "retino",
                                                               "arcer",
                                                               "skraver",
                                                               "šraf",
                                                               "sraf",
                                                               "kreskow",
                                                               "tarama",
                                                               "rayado",
                                                               "rellen",
                                                               "штрих",
                                                               "заливк",
                                                               "填充",
                                                               "해치",
                                                               "achs",
                                                               "eixos",
                                                               "axlar",
                                                               "tengely",
                                                               "osie",
                                                               "osy",
                                                               "axen",
                                                               "akslinj",
                                                               "akselij",
                                                               "axonum",
                                                               "осеве",
                                                               "осевы",
                                                               "координационн",
                                                               "轴线",
                                                               "轴网",
                                                               "轴号",
                                                               "軸線",
                                                               "통심",
                                                               "gridlin",
                                                               "elect",
                                                               "elekt",
                                                               "elett",
                                                               "eléct",
                                                               "élect",
                                                               "eletr",
                                                               "elett",
                                                               "sähkö",
                                                               "sahko",
                                                               "villany",
                                                               "elektrik",
                                                               "электр",
                                                               "електр",
                                                               "ηλεκτρ",
                                                               "电气",
                                                               "電気",
                                                               "전기",
                                                               "照明",
                                                               "beleucht",
                                                               "leucht",
                                                               "steckdos",
                                                               "enchuf",
                                                               "lumin",
                                                               "belysn",
                                                               "освещ",
                                                               "освітл",
                                                               "plumb",
                                                               "sanitär",
                                                               "sanitaer",
                                                               "sanitar",
                                                               "sanitair",
                                                               "sanear",
                                                               "fontan",
                                                               "plombe",
                                                               "idraul",
                                                               "hidraul",
                                                               "hydraul",
                                                               "saniteh",
                                                               "rohrl",
                                                               "vodovod",
                                                               "kanaliz",
                                                               "vízvez",
                                                               "tesisat",
                                                               "сантех",
                                                               "водопр",
                                                               "канализ",
                                                               "υδραυλ",
                                                               "给排水",
                                                               "給排水",
                                                               "卫生",
                                                               "洁具",
                                                               "衛生",
                                                               "위생",
                                                               "hvac",
                                                               "lüftung",
                                                               "lueftung",
                                                               "heizung",
                                                               "klima",
                                                               "einricht",
                                                               "ausstatt",
                                                               "titlebl",
                                                               "blattrahm",
                                                               "zeichnungsrahm",
                                                               "planrahm",
                                                               "squadrat",
                                                               "viewport",
                                                               "рамк",
                                                               "图框",
                                                               "図枠",
                                                               "도곽",
                                                               "stair",
                                                               "trepp",
                                                               "escalier",
                                                               "escaler",
                                                               "escada",
                                                               "scala",
                                                               "scalin",
                                                               "schod",
                                                               "lépcs",
                                                               "lepcs",
                                                               "merdiven",
                                                               "scări",
                                                               "stubišt",
                                                               "лестниц",
                                                               "сходи",
                                                               "σκάλ",
                                                               "σκαλ",
                                                               "楼梯",
                                                               "階段",
                                                               "계단",
                                                               "ceiling",
                                                               "overhead",
                                                               "landscap",
                                                               "vegetat",
                                                               "entourage",
                                                               "roofs",
                                                               "cotation",
                                                               "bemating",
                                                               "overordn",
                                                               "dimension",
                                                               "أثاث",
                                                               "اثاث",
                                                               "الأثاث",
                                                               "ריהוט",
                                                               "مبلمان",
                                                               "เฟอร์นิ",
                                                               "perabot",
                                                               "furnitur",
                                                               "أبعاد",
                                                               "ابعاد",
                                                               "الأبعاد",
                                                               "מידות",
                                                               "اندازه",
                                                               "ukuran",
                                                               "نصوص",
                                                               "טקסט",
                                                               "محاور",
                                                               "المحاور",
                                                               "צירים",
                                                               "محور",
                                                               "كهرباء",
                                                               "חשמל",
                                                               "درج",
                                                               "סניטר",
                                                               "sanit",
                                                               "inricht",
                                                               "फर्नीचर",
                                                               "फ़र्नीचर",
                                                               "hachag",
                                                               "hachés"});
/// The same as whole words, which begin others.
constexpr auto kNoWallWords = std::to_array<std::string_view>(
    {"mobles",   "माप",     "nội",       "kích",   "kich",    "eqpm",        "hilfslinien",
     "retini",   "retino",  "stramien",  "opisy",  "texty",   "skraffering", "akselit",
     "yazı",     "通り芯",  "중심선",    "設備",   "furn",    "furniture",   "equip",
     "appl",     "muebles", "mueble",    "arredi", "arredo",  "arredamento", "móveis",
     "moveis",   "mobili",  "meble",     "dim",    "dims",    "dimen",       "cote",
     "cotes",    "cota",    "quote",     "maße",   "mått",    "mål",         "mitat",
     "kóty",     "koty",    "kote",      "kota",   "méret",   "meret",       "text",
     "texts",    "texte",   "textes",    "testo",  "anno",    "note",        "notes",
     "tag",      "tags",    "iden",      "txt",    "tekste",  "patt",        "pattern",
     "trama",    "mønster", "schraf",    "axis",   "axes",    "axe",         "asse",
     "assi",     "eje",     "ejes",      "eixo",   "akse",    "akser",       "osi",
     "aks",      "оси",     "ось",       "осі",    "grid",    "grids",       "raster",
     "achse",    "achsen",  "elec",      "lite",   "light",   "lights",      "licht",
     "luce",     "luces",   "luci",      "fixt",   "pipe",    "pipes",       "piping",
     "vvs",      "sani",    "wc",        "flor",   "clng",    "ovhd",        "strs",
     "evtr",     "area",    "areas",     "comm",   "powr",    "sanr",        "levl",
     "detl",     "sect",    "ttlb",      "bord",   "nplt",    "vprt",        "roof",
     "fire",     "frame",   "frames",    "border", "borders", "sheet",       "title",
     "titles",   "rahmen",  "cadre",     "marco",  "kader",   "ramka",       "ramme",
     "kehys",    "keret",   "cartouche", "stairs", "steps",   "trap",        "trappen",
     "trappa",   "trappe",  "scale",     "schody", "portaat", "case",        "casework",
     "millwork", "tree",    "trees",     "plants", "marker",  "markers",     "symbol",
     "symbols",  "legend"});

/// Words of doors, and beginnings of those with various endings.
constexpr auto kDoorWords = std::to_array<std::string_view>(
    {"cua",    "door",  "doors",  "tür",   "türen",  "tuer",    "tueren",  "tur",    "porte",
     "portes", "porta", "portas", "porte", "puerta", "puertas", "deur",    "deuren", "drzwi",
     "dveře",  "dvere", "dør",    "døre",  "dører",  "dörr",    "dörrar",  "ovi",    "ovet",
     "ajtó",   "ajtók", "ajto",   "ajtok", "kapı",   "kapılar", "kapi",    "usa",    "ușă",
     "uși",    "usi",   "vrata",  "врата", "门",     "門",      "门窗",    "ドア",   "扉",
     "建具",   "문",    "двері",  "двери", "дверь",  "ușa",     "дверные", "дверей"});
constexpr auto kDoorStems = std::to_array<std::string_view>(
    {"carpinter", "serrament", "infiss", "menuiserie", "esquadri", "πόρτ",  "θύρ",
     "πορτ",      "أبواب",     "ابواب",  "باب",        "الأبواب",  "درب",   "דלת",
     "ประตู",      "cửa",       "दरवाज",  "pintu",      "durvis",   "durys", "uksed"});
constexpr auto kDoorEnds = std::to_array<std::string_view>({"türen", "tür", "tueren", "tuer"});
constexpr auto kWindowWords = std::to_array<std::string_view>(
    {"window",   "windows", "glaz",     "glazing",  "fenster", "fenêtre",  "fenêtres", "fenetre",
     "fenetres", "ventana", "ventanas", "janela",   "janelas", "finestra", "finestre", "finestres",
     "raam",     "ramen",   "kozijn",   "kozijnen", "okno",    "okna",     "vindue",   "vinduer",
     "vindu",    "vinduer", "fönster",  "fonster",  "ikkuna",  "ikkunat",  "ablak",    "ablakok",
     "pencere",  "prozor",  "prozori",  "окно",     "окна",    "вікно",    "вікна",    "прозорец",
     "прозорци", "窗",      "窗户",     "窓",       "창",      "창문",     "vitre",    "vitrage"});
constexpr auto kWindowStems = std::to_array<std::string_view>(
    {"खिड़की",    "खिड़की",  "logi",    "fereastr", "ferestr", "παράθυρ", "παραθυρ", "verglas",
     "pencerel", "نافذة",  "نوافذ",   "شباك",     "شبابيك",  "النوافذ", "پنجره",   "חלון",
     "חלונות",   "หน้าต่าง", "jendela", "langas",   "langai",  "aknad"});

/// Words of blocks and groups of furniture and fixtures.
constexpr auto kThingWords = std::to_array<std::string_view>(
    {"bed",          "beds",     "sofa",      "couch",   "chair",       "chairs",     "armchair",
     "table",        "tables",   "desk",      "desks",   "stool",       "bench",      "toilet",
     "sink",         "basin",    "washbasin", "bathtub", "tub",         "shower",     "fridge",
     "refrigerator", "stove",    "oven",      "cooker",  "hob",         "dishwasher", "washer",
     "cupboard",     "wardrobe", "cabinet",   "shelf",   "bookshelf",   "bookcase",   "lamp",
     "plant",        "piano",    "car",       "bett",    "tisch",       "stuhl",      "sessel",
     "schrank",      "regal",    "herd",      "spüle",   "waschbecken", "badewanne",  "dusche",
     "lit",          "chaise",   "fauteuil",  "canapé",  "canape",      "armoire",    "évier",
     "evier",        "lavabo",   "baignoire", "douche",  "letto",       "tavolo",     "sedia",
     "armadio",      "divano",   "poltrona",  "lavello", "vasca",       "doccia",     "cama",
     "mesa",         "silla",    "sillon",    "armario", "ducha",       "cadeira",    "стол",
     "стул",         "диван",    "кровать",   "шкаф",    "床",          "桌",         "椅",
     "沙发",         "马桶"});

/// The parts of a layer's name by ISO 13567-2 that count: the element by the tables of CI/SfB, and
/// the presentation.
struct IsoLayer {
    int element = 0;          ///< two digits; 0: none
    char presentation = '-';  ///< E element, T text, H hatching, D dimension, and others
};

/// Parses names of BS 1192, such as A210G701_WALL: an author, three digits of CI/SfB, a graphic (G
/// or M elements, D dimensions, T text, H hatching) and the digit of a pen. 315 is a door in an
/// outer wall.
std::optional<IsoLayer> britishLayer(std::string_view name) {
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    constexpr std::size_t kLeast = 6;
    if (name.size() < kLeast || std::string_view("AISC").find(name[0]) == std::string_view::npos ||
        !std::all_of(name.begin() + 1, name.begin() + 4, is_digit) ||
        std::string_view("ACDGHTZM").find(name[4]) == std::string_view::npos || !is_digit(name[5]))
        return std::nullopt;
    const int element = 10 * (name[1] - '0') + (name[2] - '0');
    constexpr int kOuterOpenings = 31, kInnerOpenings = 32;
    const bool is_outer_door = element == kOuterOpenings && name[3] == '5';
    const bool is_element = name[4] == 'G' || name[4] == 'M';
    return IsoLayer{is_outer_door ? kInnerOpenings : element, is_element ? 'E' : 'T'};
}

/// Parses names such as A-21----E-: two characters of the agent, six of the element, two of the
/// presentation.
std::optional<IsoLayer> isoLayer(std::string_view name) {
    if (const auto british = britishLayer(name)) return british;
    constexpr std::size_t kLeast = 10;
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    if (name.size() < kLeast || name[0] < 'A' || name[0] > 'Z') return std::nullopt;
    if (!std::all_of(name.begin(), name.end(), [&](char c) {
            return is_digit(c) || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
        }))
        return std::nullopt;
    // Six digits, or fewer and filling: A-01-WALLS is no such name.
    const bool has_element = is_digit(name[2]) && is_digit(name[3]) &&
                             std::all_of(name.begin() + 4, name.begin() + 8, [&](char c) {
                                 return is_digit(c) || c == '-' || c == '_';
                             });
    if (!has_element && name.substr(2, 6) != "------") return std::nullopt;
    if (std::string_view("-EMATHDJKGUYPBFVIL").find(name[8]) == std::string_view::npos)
        return std::nullopt;
    return IsoLayer{has_element ? 10 * (name[2] - '0') + (name[3] - '0') : 0, name[8]};
}

bool showsElements(const IsoLayer& layer) {
    return layer.presentation == 'E' || layer.presentation == 'M' || layer.presentation == '-';
}

/// Returns true for a layer of the National CAD Standard of a discipline that draws no walls, as
/// E-POWR and P-FIXT: one letter, a hyphen and a group of four.
bool isOtherDiscipline(std::string_view name) {
    const auto is_letter = [](char c) { return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z'); };
    return name.size() >= 6 && std::string_view("EPMTFLVepmtflv").find(name[0]) < 14 &&
           name[1] == '-' && std::all_of(name.begin() + 2, name.begin() + 6, is_letter) &&
           (name.size() == 6 || name[6] == '-');
}

/// Returns true for dimensions and hatching of the descriptive BS 1192 (A-Wall-D, A-Wall-H), and
/// for what the National CAD Standard marks as demolished (A-WALL-D).
bool isOffPlan(std::string_view name) {
    return name.size() > 4 && name[0] >= 'A' && name[0] <= 'Z' && name[1] == '-' &&
           (name.ends_with("-D") || name.ends_with("-H"));
}

template <typename Words, typename Stems>
bool hasWordOf(const std::vector<std::string>& words, const Words& whole, const Stems& stems) {
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
        return isOneOf(whole, word) ||
               std::any_of(stems.begin(), stems.end(),
                           [&](std::string_view stem) { return word.starts_with(stem); });
    });
}

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

/// Returns true if a part of a compound word means something other than walls.
bool hasOtherPart(const std::vector<std::string>& words) {
    // Scripts without blanks between words: U+3000 and above.
    const auto is_unspaced = [](std::string_view stem) {
        return static_cast<unsigned char>(stem.front()) >= 0xE3;
    };
    return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
        return std::any_of(kNoWallEnds.begin(), kNoWallEnds.end(),
                           [&](std::string_view end) { return word.ends_with(end); }) ||
               std::any_of(kNoWallStems.begin(), kNoWallStems.end(), [&](std::string_view stem) {
                   return is_unspaced(stem) && word.find(stem) != std::string::npos;
               });
    });
}

/// Returns true if a word means wall, whatever the others mean.
bool hasWallWord(const std::vector<std::string>& words) {
    return std::any_of(words.begin(), words.end(), [](const std::string& word) {
        const auto has = [&](std::string_view part) {
            return word.find(part) != std::string::npos;
        };
        return isOneOf(kWallWords, word) ||
               std::any_of(kWallEnds.begin(), kWallEnds.end(),
                           [&](std::string_view end) { return word.ends_with(end); }) ||
               (std::any_of(kWallParts.begin(), kWallParts.end(), has) &&
                std::none_of(kOtherParts.begin(), kOtherParts.end(), has));
    });
}

/// Returns true for "cửa sổ", which begins as "cửa đi", a door.
bool isVietnameseWindow(const std::vector<std::string>& words) {
    const auto cua = std::find_if(words.begin(), words.end(), [](const std::string& word) {
        return word == "cửa" || word == "cua";
    });
    return cua != words.end() && cua + 1 != words.end() && (cua[1] == "sổ" || cua[1] == "so");
}

/// Names are shorter: of more, no word is looked for.
std::string_view beginning(std::string_view name) {
    constexpr std::size_t kLongest = 255;  // bytes, of a layer in DXF
    return name.substr(0, kLongest);
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

bool matchesLayer(const std::vector<std::string>& globs, std::string_view layer) {
    const std::string name = lowerCased(layer);
    return std::any_of(globs.begin(), globs.end(), [&](const std::string& glob) {
        return Glob(lowerCased(glob)).matches(name);
    });
}

bool isWallName(std::string_view full_name) {
    const std::string_view name = beginning(full_name);
    if (isOffPlan(name)) return false;
    if (const auto iso = isoLayer(name))
        return showsElements(*iso) && (iso->element == 21 || iso->element == 22);
    const std::vector<std::string> words = wordsOf(name);
    if (std::any_of(words.begin(), words.end(),
                    [](const std::string& word) { return isOneOf(kOtherWords, word); }))
        return false;
    return hasWallWord(words);
}

bool isNoWallName(std::string_view full_name) {
    const std::string_view name = beginning(full_name);
    if (const auto iso = isoLayer(name)) {
        const int group = iso->element / 10;
        return !showsElements(*iso) || group >= 4 ||
               (group == 2 && iso->element != 21 && iso->element != 22 && iso->element != 28);
    }
    if (isWallName(name)) return false;
    return isOffPlan(name) || isOtherDiscipline(name) ||
           hasWordOf(wordsOf(name), kNoWallWords, kNoWallStems) || hasOtherPart(wordsOf(name));
}

bool isDoorName(std::string_view full_name) {
    const std::string_view name = beginning(full_name);
    if (const auto iso = isoLayer(name)) return showsElements(*iso) && iso->element == 32;
    const std::vector<std::string> words = wordsOf(name);
    // Walls and doors on one layer are walls.
    if (isNoWallName(name) || hasWallWord(words)) return false;
    if (isVietnameseWindow(words)) return false;
    return hasWordOf(words, kDoorWords, kDoorStems) ||
           std::any_of(words.begin(), words.end(), [](const std::string& word) {
               return std::any_of(kDoorEnds.begin(), kDoorEnds.end(),
                                  [&](std::string_view end) { return word.ends_with(end); });
           });
}

bool isWindowName(std::string_view full_name) {
    const std::string_view name = beginning(full_name);
    if (const auto iso = isoLayer(name)) return showsElements(*iso) && iso->element == 31;
    return !isNoWallName(name) && !isDoorName(name) &&
           (isVietnameseWindow(wordsOf(name)) ||
            hasWordOf(wordsOf(name), kWindowWords, kWindowStems));
}

bool isThingName(std::string_view full_name) {
    const std::string_view name = beginning(full_name);
    const std::vector<std::string> words = wordsOf(name);
    return !isWallName(name) &&
           (hasWordOf(words, kThingWords, std::array<std::string_view, 0>()) || isNoWallName(name));
}

}  // namespace ispace
