// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cctype>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace arris {

/// A value of a USD text file: a number, a string, or a list in () or [].
struct UsdaValue {
    char kind = 'n';  ///< n number, s string, ( tuple, [ array
    double number = 0.0;
    std::string text;
    std::vector<UsdaValue> items;

    /// The numbers in it, outermost first.
    std::vector<double> numbers() const
    {
        if (kind == 'n') return {number};
        std::vector<double> all;
        for (const UsdaValue& item : items)
            for (const double value : item.numbers()) all.push_back(value);
        return all;
    }
};

struct UsdaAttribute {
    std::string type;
    std::vector<UsdaValue> value;         ///< one or none: the default
    std::map<double, UsdaValue> samples;  ///< by time code
    std::map<std::string, UsdaValue> metadata;
};

struct UsdaPrim {
    std::string type, name;
    std::map<std::string, UsdaAttribute> attributes;
    std::vector<UsdaPrim> children;
};

/// What a text stage says, the attributes of its root's first child at hand, read by the grammar of the
/// format and not by that of our writer: white space, order and trailing commas are free. Throws
/// std::runtime_error with the place of an error.
class UsdaParser {
  public:
    std::map<std::string, UsdaValue> stage;
    std::string root;  ///< name of the first prim, which has all others below it
    std::string prim_type, prim_name;
    std::map<std::string, UsdaAttribute> attributes;
    std::vector<UsdaPrim> others;  ///< the root's children after the first

    explicit UsdaParser(std::string text) : text_(std::move(text))
    {
        if (text_.rfind("#usda 1.0\n", 0) != 0) fail("no #usda header");
        at_ = 10;
        if (skips("(")) stage = parse_metadata();
        UsdaPrim top = parse_prim();
        skip_space();
        if (at_ != text_.size()) fail("a second root");
        if (top.children.empty()) fail("an empty root");
        root = top.name;
        prim_type = top.children[0].type;
        prim_name = top.children[0].name;
        attributes = top.children[0].attributes;
        others.assign(top.children.begin() + 1, top.children.end());
    }

  private:
    [[noreturn]] void fail(const std::string& what) const
    {
        throw std::runtime_error(what + " at byte " + std::to_string(at_) + ": " + text_.substr(at_, 40));
    }

    void skip_space()
    {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    }

    bool skips(const std::string& token)
    {
        skip_space();
        if (text_.compare(at_, token.size(), token) != 0) return false;
        at_ += token.size();
        return true;
    }

    void expect(const std::string& token)
    {
        if (!skips(token)) fail("expected " + token);
    }

    std::string parse_word()
    {
        skip_space();
        const std::size_t begin = at_;
        while (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_' || text_[at_] == ':')
            ++at_;
        if (at_ == begin) fail("expected a name");
        return text_.substr(begin, at_ - begin);
    }

    std::string parse_string()
    {
        expect("\"");
        std::string result;
        for (;; ++at_) {
            if (at_ >= text_.size() || text_[at_] == '\n') fail("unclosed string");
            if (text_[at_] == '"') break;
            if (text_[at_] != '\\') {
                result += text_[at_];
                continue;
            }
            const char escaped = text_[++at_];
            if (escaped == 'x') {
                result += static_cast<char>(std::stoi(text_.substr(at_ + 1, 2), nullptr, 16));
                at_ += 2;
            } else {
                result += escaped == 'n' ? '\n' : escaped;
            }
        }
        ++at_;
        return result;
    }

    UsdaValue parse_value()
    {
        skip_space();
        UsdaValue value;
        if (text_[at_] == '"') {
            value.kind = 's';
            value.text = parse_string();
        } else if (text_[at_] == '(' || text_[at_] == '[') {
            value.kind = text_[at_++];
            const std::string close = value.kind == '(' ? ")" : "]";
            while (!skips(close)) {
                value.items.push_back(parse_value());
                if (!skips(",")) {
                    expect(close);
                    break;
                }
            }
        } else {
            value.number = parse_number();
        }
        return value;
    }

    double parse_number()
    {
        skip_space();
        char* end = nullptr;
        const double number = std::strtod(text_.c_str() + at_, &end);
        if (end == text_.c_str() + at_) fail("expected a number");
        at_ = static_cast<std::size_t>(end - text_.c_str());
        return number;
    }

    std::map<std::string, UsdaValue> parse_metadata()
    {
        std::map<std::string, UsdaValue> metadata;
        while (!skips(")")) {
            const std::string name = parse_word();
            expect("=");
            metadata[name] = parse_value();
        }
        return metadata;
    }

    UsdaPrim parse_prim()
    {
        UsdaPrim prim;
        expect("def ");
        prim.type = parse_word();
        prim.name = parse_string();
        expect("{");
        while (!skips("}")) {
            skip_space();
            if (text_.compare(at_, 4, "def ") == 0)
                prim.children.push_back(parse_prim());
            else
                parse_attribute(prim);
        }
        return prim;
    }

    void parse_attribute(UsdaPrim& prim)
    {
        std::string type = parse_word();
        if (type == "uniform") type += " " + parse_word();
        if (skips("[]")) type += "[]";
        const std::string name = parse_word();
        UsdaAttribute& attribute = prim.attributes[name];
        if (!attribute.type.empty() && attribute.type != type) fail(name + " has two types");
        attribute.type = type;
        if (skips(".timeSamples")) {
            expect("=");
            expect("{");
            while (!skips("}")) {
                const double time = parse_number();
                expect(":");
                if (!attribute.samples.emplace(time, parse_value()).second) fail("two samples at one time");
                skips(",");
            }
        } else if (skips("=")) {
            attribute.value.push_back(parse_value());
        }
        if (skips("(")) attribute.metadata = parse_metadata();
    }

    std::string text_;
    std::size_t at_ = 0;
};

}  // namespace arris
