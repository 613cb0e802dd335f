// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/study_files.h"
#include "app/study/study_panels.h"

namespace arris {
namespace {

using Json = nlohmann::ordered_json;

Json optional(const std::optional<double>& value)
{
    return value ? Json(*value) : Json();
}

Json slopes_json(const Study& study, const std::vector<RunOutcome>& outcomes)
{
    Json slopes = Json::array();
    for (const NumericKey& key : list_numeric_keys(study))
        for (const StudyCurve& curve : make_curves(study, outcomes, key.key)) {
            Json entry = {{"key", key.key}, {"curve", curve.name}, {"slope", optional(curve.slope)}};
            if (!study.error)
                for (const PhaseExponent& phase : fit_phases(outcomes, curve))
                    entry["phases"][phase.phase] = optional(phase.exponent);
            slopes.push_back(entry);
        }
    return slopes;
}

}  // namespace

Json study_json(const Study& study, const std::vector<RunOutcome>& outcomes,
                const StudyProvenance& provenance)
{
    Json json = {{"title", study.title},
                 {"quick", study.is_quick},
                 {"sentence", tell_cheapest(study, outcomes)},
                 {"error", tell_error(study, outcomes)},
                 {"repeats", study.repeats},
                 {"slopes", slopes_json(study, outcomes)},
                 {"front", Json::array()},
                 {"failed", Json::array()},
                 {"engine", provenance.engine},
                 {"version", provenance.version},
                 {"build", provenance.build},
                 {"machines", provenance.machines}};
    for (const std::size_t i : find_pareto_front(outcomes)) json["front"].push_back(outcomes[i].run.name);
    for (const RunOutcome& outcome : outcomes)
        if (!outcome.is_finished())
            json["failed"].push_back(
                {{"run", outcome.run.name}, {"status", outcome.status}, {"message", outcome.message}});
    return json;
}

}  // namespace arris
