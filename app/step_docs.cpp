// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/step_docs.h"

#include <fmt/format.h>

#include "solver/retry_policy.h"
#include "solver/rounds.h"

namespace arris {

std::string step_markdown()
{
    const auto or_none = [](std::string_view bound) { return bound.empty() ? "-" : bound; };
    std::string text = "| a round ends as | what follows | bound |\n|---|---|---|\n";
    for (const RoundRule& rule : list_round_rules())
        text += fmt::format("| {} | {} | {} |\n", rule.end, rule.next, or_none(rule.bound));
    text += "\n| a failed attempt, the first that holds | next attempt | bound |\n|---|---|---|\n";
    for (const AttemptRule& rule : list_attempt_rules())
        text += fmt::format("| {} | {} | {} |\n", rule.condition, rule.next, or_none(rule.bound));
    return text;
}

}  // namespace arris
