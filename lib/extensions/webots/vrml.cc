// SPDX-License-Identifier: GPL-3.0-or-later
// Parses the syntax of Webots' worlds (VRML97: ISO/IEC 14772-1, clause 5; Webots, "Scene Tree"),
// without the types of nodes and fields. Nodes are stored once; USE shares them.
#include "extensions/webots/vrml.h"

#include <algorithm>

#include "base/message.h"
#include "base/number.h"
#include "io/importers.h"

namespace ispace::webots {

namespace {

/// Units of Budget for a node: it takes some 200 bytes of memory.
constexpr std::size_t kNodeWork = 4;

enum class TokenKind { End, Open, Close, ListOpen, ListClose, Text, Word };

struct Token {
    TokenKind kind = TokenKind::End;
    std::string_view word = {};  ///< as written, a text with its quotes
    int line = 0;
};

/// Splits a file into braces, brackets, texts and words; commas are blanks, `#` begins a comment.
class VrmlTokens {
  public:
    VrmlTokens(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {}

    Token next() {
        skipBlanks();
        if (rest_.empty()) return {TokenKind::End, {}, line_};
        constexpr std::string_view kMarks = "{}[]";
        if (const std::size_t mark = kMarks.find(rest_.front()); mark != std::string_view::npos) {
            constexpr TokenKind kKinds[] = {TokenKind::Open, TokenKind::Close, TokenKind::ListOpen,
                                            TokenKind::ListClose};
            return take(kKinds[mark], 1);
        }
        if (rest_.front() == '"') return take(TokenKind::Text, textLength());
        const std::size_t end = rest_.find_first_of(" \t\r\n,{}[]\"#");
        return take(TokenKind::Word, std::min(end, rest_.size()));
    }

  private:
    void skipBlanks() {
        while (!rest_.empty()) {
            if (rest_.front() == '#')
                rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
            else if (std::string_view(" \t\r\n,").find(rest_.front()) != std::string_view::npos)
                static_cast<void>(take(TokenKind::Word, 1));
            else
                return;
        }
    }

    [[nodiscard]] std::size_t textLength() const {
        for (std::size_t i = 1; i < rest_.size(); ++i)
            if (rest_[i] == '\\')
                ++i;
            else if (rest_[i] == '"')
                return i + 1;
        failFile(name_, "a text without its closing quote", line_);
    }

    Token take(TokenKind kind, std::size_t length) {
        const Token token{kind, rest_.substr(0, length), line_};
        line_ += static_cast<int>(std::count(token.word.begin(), token.word.end(), '\n'));
        rest_.remove_prefix(length);
        return token;
    }

    std::string_view rest_;
    const std::string& name_;
    int line_ = 1;
};

/// Returns the content of a text in quotes.
std::string unquoted(std::string_view text) {
    std::string content;
    for (std::size_t i = 1; i + 1 < text.size(); ++i) {
        if (text[i] == '\\' && i + 2 < text.size()) ++i;
        content += text[i];
    }
    return content;
}

}  // namespace

const VrmlValue* VrmlNode::field(std::string_view name) const {
    const auto found = std::find_if(fields.rbegin(), fields.rend(),
                                    [name](const auto& field) { return field.first == name; });
    return found == fields.rend() ? nullptr : &found->second;
}

class VrmlFile::Parser {
  public:
    Parser(std::string_view bytes, const std::string& name, Budget& work, VrmlFile& file)
        : tokens_(bytes, name), name_(name), work_(work), file_(file), token_(tokens_.next()) {}

    void parse() {
        while (token_.kind != TokenKind::End) {
            const Token first = expect(TokenKind::Word, "a node");
            if (first.word == "EXTERNPROTO" || first.word == "IMPORTABLE") {
                if (first.word == "IMPORTABLE") expect(TokenKind::Word, "EXTERNPROTO");
                expect(TokenKind::Text, "the file of a PROTO");
            } else if (first.word == "PROTO") {
                fail("a PROTO, wanted a world (.wbt)", first);
            } else {
                file_.roots_.push_back(node(first, 0));
            }
        }
    }

  private:
    [[noreturn]] void fail(const std::string& message, const Token& token) const {
        failFile(name_, message, token.line);
    }

    [[noreturn]] void failWanted(const char* wanted) const {
        fail((token_.kind == TokenKind::End ? std::string("the file ends")
                                            : "found " + excerpt(token_.word)) +
                 ", wanted " + wanted,
             token_);
    }

    Token advance() {
        const Token token = token_;
        token_ = tokens_.next();
        return token;
    }

    Token expect(TokenKind kind, const char* wanted) {
        if (token_.kind != kind) failWanted(wanted);
        return advance();
    }

    /// Parses the node that begins with a word: its type, DEF or USE.
    const VrmlNode* node(const Token& first, int depth) {
        if (depth > kMaxDepth)
            fail("nodes nested more than " + std::to_string(kMaxDepth) + " deep", first);
        if (first.word == "USE") {
            const Token name = expect(TokenKind::Word, "the name of a node");
            const auto known = defs_.find(name.word);
            if (known == defs_.end()) fail("no node before is called " + excerpt(name.word), name);
            return known->second;
        }
        VrmlNode parsed;
        parsed.line = first.line;
        parsed.type = first.word;
        if (first.word == "DEF") {
            parsed.def = expect(TokenKind::Word, "the name of a node").word;
            parsed.type = expect(TokenKind::Word, "the type of a node").word;
        }
        if (!work_.take(kNodeWork)) fail("its nodes make " + work_.excess(), first);
        expect(TokenKind::Open, "{ after the type of a node");
        while (token_.kind != TokenKind::Close) {
            Token name = expect(TokenKind::Word, "the name of a field or }");
            // State of a running simulation that Webots stores: `hidden position_0_0 0.5`.
            if (name.word == "hidden") name = expect(TokenKind::Word, "the name of a field");
            VrmlValue value = fieldValue(depth);
            parsed.fields.emplace_back(name.word, std::move(value));
        }
        advance();
        const VrmlNode* kept = &file_.nodes_.emplace_back(std::move(parsed));
        if (!kept->def.empty()) defs_[kept->def] = kept;
        return kept;
    }

    VrmlValue fieldValue(int depth) {
        VrmlValue value;
        if (token_.kind == TokenKind::ListOpen) {
            advance();
            while (token_.kind != TokenKind::ListClose) addElement(value, depth);
            advance();
            return value;
        }
        addElement(value, depth);
        if (!value.numbers.empty())
            while (token_.kind == TokenKind::Word && parseDouble(token_.word))
                addElement(value, depth);
        if (!value.texts.empty())
            while (token_.kind == TokenKind::Text) addElement(value, depth);
        return value;
    }

    void addElement(VrmlValue& value, int depth) {
        if (token_.kind == TokenKind::Text) {
            value.texts.push_back(unquoted(advance().word));
            return;
        }
        if (token_.kind != TokenKind::Word) failWanted("a value");
        const Token word = advance();
        if (const auto number = parseDouble(word.word))
            value.numbers.push_back(*number);
        else if (word.word == "TRUE" || word.word == "FALSE" || word.word == "NULL")
            value.word = word.word;
        else if (word.word == "DEF" || word.word == "USE" || token_.kind == TokenKind::Open)
            value.nodes.push_back(node(word, depth + 1));
        else
            fail("found " + excerpt(word.word) + ", wanted a value", word);
    }

    VrmlTokens tokens_;
    const std::string& name_;
    Budget& work_;
    VrmlFile& file_;
    Token token_;
    std::map<std::string_view, const VrmlNode*> defs_;
};

VrmlFile::VrmlFile(std::string_view bytes, const std::string& name, Budget& work) {
    constexpr std::string_view kMagic = "#VRML_SIM ";
    if (bytes.starts_with(kMagic)) {
        version_ = bytes.substr(kMagic.size());
        version_ = version_.substr(0, version_.find_first_of(" \t\r\n"));
    }
    Parser(bytes, name, work, *this).parse();
}

}  // namespace ispace::webots
