// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/usd/usda_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"

namespace arris {
namespace {

constexpr std::size_t kBlock = 1 << 16;
constexpr std::size_t kLongestWord = 1000;
constexpr std::size_t kDeepest = 200;  // brackets within brackets

bool is_word_character(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' ||
           static_cast<unsigned char>(c) >= 0x80;
}

char closing(char opening)
{
    return opening == '(' ? ')' : opening == '[' ? ']' : '}';
}

}  // namespace

UsdScanner::UsdScanner(const InputFile& file, const UsdPlace& place)
    : file_(file), block_offset_(place.offset), line_(place.line)
{
}

void UsdScanner::refuse(const std::string& why) const
{
    throw InputError(fmt::format("{}: line {}: {}", file_.path(), line_, why));
}

void UsdScanner::fill(std::size_t ahead)
{
    block_offset_ += at_;
    block_.erase(0, at_);
    at_ = 0;
    const std::size_t kept = block_.size();
    const std::uint64_t left = file_.size() - std::min(file_.size(), block_offset_ + kept);
    block_.resize(kept + static_cast<std::size_t>(std::min<std::uint64_t>(left, kBlock + ahead)));
    if (block_.size() > kept) file_.read(block_offset_ + kept, block_.data() + kept, block_.size() - kept);
}

char UsdScanner::look(std::size_t ahead)
{
    if (at_ + ahead >= block_.size()) fill(ahead);
    return at_ + ahead < block_.size() ? block_[at_ + ahead] : '\0';
}

void UsdScanner::advance()
{
    if (look() == '\n') ++line_;
    if (at_ < block_.size()) ++at_;
}

void UsdScanner::skip_blanks()
{
    const auto is_at_end = [&] { return look() == '\0' && at_ >= block_.size(); };
    for (;;) {
        const char c = look();
        if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
            advance();
        } else if (c == '#' || (c == '/' && look(1) == '/')) {
            while (!is_at_end() && look() != '\n') advance();
        } else if (c == '/' && look(1) == '*') {
            while (!(look() == '*' && look(1) == '/')) {
                if (is_at_end()) refuse("a comment does not end");
                advance();
            }
            advance();
            advance();
        } else {
            return;
        }
    }
}

char UsdScanner::next()
{
    skip_blanks();
    const char c = look();
    if (c == '\0' && at_ < block_.size()) refuse("a zero byte; allowed: text");
    return c;
}

UsdPlace UsdScanner::place()
{
    next();
    return {block_offset_ + at_, line_};
}

bool UsdScanner::take(char mark)
{
    if (next() != mark) return false;
    advance();
    return true;
}

void UsdScanner::require(char mark)
{
    if (take(mark)) return;
    const char found = next();
    refuse(found == '\0' ? fmt::format("the file ends where '{}' is missing", mark)
                         : one_line(fmt::format("'{}' where '{}' is missing", found, mark)));
}

std::string UsdScanner::take_characters(std::string_view also)
{
    next();
    std::string word;
    while (is_word_character(look()) || (look() != '\0' && also.find(look()) != std::string_view::npos)) {
        if (word.size() == kLongestWord) refuse(fmt::format("a word of more than {} bytes", kLongestWord));
        word += look();
        advance();
    }
    return word;
}

std::string UsdScanner::take_word()
{
    std::string word = take_characters(".:-+");
    if (word.empty()) {
        const char found = next();
        refuse(found == '\0' ? "the file ends where a word is missing"
                             : one_line(fmt::format("'{}' where a word is missing", found)));
    }
    return word;
}

double UsdScanner::take_number()
{
    const std::string word = take_characters(".-+");
    const ParsedNumber number = parse_number(word);
    if (number.error != NumberError::None)
        refuse(fmt::format("'{}' is no number",
                           word.empty() ? one_line(std::string(1, next())) : one_line(excerpt(word))));
    return number.value;
}

void UsdScanner::take_tuple(std::size_t count, std::vector<double>& numbers)
{
    require('(');
    for (std::size_t k = 0; k < count; ++k) {
        if (k > 0) require(',');
        numbers.push_back(take_number());
    }
    require(')');
}

bool UsdScanner::skip_quoted(std::string* text)
{
    const char quote = next();
    if (quote != '"' && quote != '\'' && quote != '@' && quote != '<') return false;
    const char end = quote == '<' ? '>' : quote;
    const std::size_t count = quote != '<' && look(1) == quote && look(2) == quote ? 3 : 1;
    for (std::size_t k = 0; k < count; ++k) advance();
    const auto is_end = [&] {
        for (std::size_t k = 0; k < count; ++k)
            if (look(k) != end) return false;
        return true;
    };
    const std::uint64_t first_line = line_;
    while (!is_end()) {
        if (look() == '\0' && at_ >= block_.size())
            refuse(fmt::format("a text that begins in line {} does not end", first_line));
        const bool is_escape = look() == '\\' && (quote == '"' || quote == '\'');
        if (text != nullptr && text->size() < kLongestWord) *text += look();
        advance();
        if (is_escape) advance();
    }
    for (std::size_t k = 0; k < count; ++k) advance();
    return true;
}

std::string UsdScanner::take_text()
{
    std::string text;
    const char quote = next();
    if ((quote != '"' && quote != '\'') || !skip_quoted(&text)) refuse("a text in quotes is missing");
    return text;
}

UsdSkipped UsdScanner::skip_group()
{
    UsdSkipped skipped;
    std::string open;
    do {
        const char c = next();
        if (c == '\0') refuse("the file ends inside brackets");
        if (c == '(' || c == '[' || c == '{') {
            if (open.size() == kDeepest)
                refuse(fmt::format("more than {} brackets within brackets", kDeepest));
            if (open.size() == 1) ++skipped.groups;
            open += closing(c);
            advance();
        } else if (c == ')' || c == ']' || c == '}') {
            if (c != open.back()) refuse(fmt::format("'{}' where '{}' is missing", c, open.back()));
            open.pop_back();
            advance();
        } else if (!skip_quoted(nullptr)) {
            advance();
        }
    } while (!open.empty());
    return skipped;
}

UsdSkipped UsdScanner::skip_value()
{
    UsdSkipped skipped;
    const char c = next();
    if (c == '(' || c == '[' || c == '{')
        skipped = skip_group();
    else if (!skip_quoted(nullptr))
        skipped.is_blocked = take_word() == "None";
    // A reference to a prim of another file: @file@</prim>
    if (c == '@' && next() == '<') skip_quoted(nullptr);
    return skipped;
}

}  // namespace arris
