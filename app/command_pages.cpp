// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/command_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace arris {
namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app)
{
    return app.get_subcommands([](const CLI::App*) { return true; });
}

/// Text for roff: hyphens that may be copied, no escapes, no line that roff takes for a request.
std::string roff(const std::string& text)
{
    std::string out;
    bool begins_line = true;
    for (const char c : text) {
        if (begins_line && (c == '.' || c == '\'')) out += "\\&";
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
        begins_line = c == '\n';
    }
    return out;
}

/// "-o, --output", or the name of a positional argument.
std::string names_of(const CLI::Option& option)
{
    if (option.get_positional()) return option.get_name();
    std::string names;
    for (const std::string& name : option.get_snames()) names += (names.empty() ? "-" : ", -") + name;
    for (const std::string& name : option.get_lnames()) names += (names.empty() ? "--" : ", --") + name;
    return names;
}

bool takes_value(const CLI::Option& option)
{
    return option.get_expected_max() > 0;
}

/// The words that an option allows, with blanks between them, from its type "TEXT:{local,slurm}".
std::string allowed_words(const CLI::Option& option)
{
    const std::string type = option.get_type_name();
    const std::size_t begin = type.find('{'), end = type.rfind('}');
    if (begin == std::string::npos || end == std::string::npos || end < begin) return "";
    std::string words = type.substr(begin + 1, end - begin - 1);
    std::replace(words.begin(), words.end(), ',', ' ');
    return words;
}

std::string option_entry(const CLI::Option& option)
{
    std::string entry = ".TP\n\\fB" + roff(names_of(option)) + "\\fR";
    const bool is_named = !option.get_positional();
    if (is_named && takes_value(option)) entry += " \\fI" + roff(option.get_type_name()) + "\\fR";
    return entry + "\n" + roff(option.get_description()) + "\n";
}

std::string command_entry(const CLI::App& command)
{
    std::string entry =
        ".SS arris " + roff(command.get_name()) + "\n" + roff(command.get_description()) + ".\n";
    for (const CLI::Option* option : command.get_options()) entry += option_entry(*option);
    return entry + ".PP\n.nf\n" + roff(command.get_footer()) + "\n.fi\n";
}

/// Long and short names of the options, with blanks between them.
std::string option_words(const CLI::App& command)
{
    std::string words;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) words += " --" + name;
        for (const std::string& name : option->get_snames()) words += " -" + name;
    }
    return words.empty() ? words : words.substr(1);
}

/// Branches of a `case` over "command previous-word" for options, and "command ." for positional arguments.
std::string value_branches(const CLI::App& command)
{
    std::string branches;
    for (const CLI::Option* option : command.get_options()) {
        if (!takes_value(*option)) continue;
        std::vector<std::string> keys;
        if (option->get_positional()) keys.push_back(".");
        for (const std::string& name : option->get_lnames()) keys.push_back("--" + name);
        for (const std::string& name : option->get_snames()) keys.push_back("-" + name);
        std::string pattern;
        for (const std::string& key : keys)
            pattern += fmt::format("{}'{} {}'", pattern.empty() ? "" : "|", command.get_name(), key);
        branches += fmt::format("        {}) echo '{}' ;;\n", pattern, allowed_words(*option));
    }
    return branches;
}

}  // namespace

std::string list_commands(const CLI::App& app)
{
    std::string names;
    for (const CLI::App* command : commands_of(app))
        names += (names.empty() ? "" : ", ") + command->get_name();
    return names;
}

std::string man_page(const CLI::App& app, const std::string& version)
{
    std::string page = ".TH ARRIS 1 \"\" \"arris " + roff(version) + "\" \"User Commands\"\n";
    page += ".SH NAME\narris \\- cloth that slides over sharp edges\n.SH SYNOPSIS\n";
    page += ".B arris\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n";
    page += ".SH DESCRIPTION\n" + roff(app.get_description()) + "\n.SH OPTIONS\n";
    for (const CLI::Option* option : app.get_options()) page += option_entry(*option);
    page += ".SH COMMANDS\n";
    for (const CLI::App* command : commands_of(app)) page += command_entry(*command);
    page += ".SH NOTES\n" + roff(app.get_footer()) + "\n";
    return page;
}

std::string bash_completion(const CLI::App& app)
{
    std::string names, options, values;
    for (const CLI::App* command : commands_of(app)) {
        names += (names.empty() ? "" : " ") + command->get_name();
        options += fmt::format("        '{}') echo '{}' ;;\n", command->get_name(), option_words(*command));
        values += value_branches(*command);
    }
    // Where a function prints nothing, `-o default` makes bash complete file names.
    return "# Completion of arris for bash, printed by `arris docs bash`.\n_arris_options() {\n    case $1 "
           "in\n" +
           options + fmt::format("        '') echo '{}' ;;\n", option_words(app)) +
           "    esac\n}\n_arris_values() {\n    case \"$1 $2\" in\n" + values +
           "        *) return 1 ;;\n    esac\n}\n_arris() {\n"
           "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command= words=\n"
           "    [ \"$COMP_CWORD\" -gt 1 ] && command=${COMP_WORDS[1]}\n"
           "    if [[ $before == -* ]] && words=$(_arris_values \"$command\" \"$before\"); then :\n"
           "    elif [[ $word == -* ]]; then words=$(_arris_options \"$command\")\n"
           "    elif [ -z \"$command\" ]; then words='" +
           names +
           "'\n"
           "    else words=$(_arris_values \"$command\" .); fi\n"
           "    COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n}\n"
           "complete -o default -F _arris arris\n";
}

}  // namespace arris
