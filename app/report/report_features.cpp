// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/report/report_features.h"

#include <fmt/format.h>

namespace arris {
namespace {

std::string feature_row(const std::string& name, std::int64_t count, const std::string& what)
{
    return fmt::format("<tr><th scope=\"row\">{}</th><td class=\"count\">{}</td><td>{}</td></tr>\n", name,
                       count, what);
}

}  // namespace

const char* explain(ConstraintCause cause)
{
    switch (cause) {
        case ConstraintCause::New:
            return "the contact is new: every contact is a row in its first step";
        case ConstraintCause::NotCrossing:
            return "the cloth does not pass over the feature there, so there is no place for an EOL vertex";
        case ConstraintCause::AtEol:
            return "repeats the contact of an EOL vertex on an edge or face beside that vertex";
        case ConstraintCause::BesideEol:
            return "its place is taken by an EOL vertex of the feature, but the cloth touches the feature "
                   "elsewhere";
        case ConstraintCause::FlatBehind:
            return "the cloth lies flat on a face beside the feature, behind a fold that has left the "
                   "feature";
        case ConstraintCause::Unresolved:
            return "the feature is finer than the cells of the cloth, which cannot follow it";
        case ConstraintCause::NearBorder:
            return "the cloth's border is so near that it would slide past an EOL vertex at once";
        case ConstraintCause::BorderAhead:
            return "the cloth's border moves towards the contact and would reach it within a few steps";
        case ConstraintCause::Guard:
            return "the mesh change for an EOL vertex would strain the cloth or pass through an obstacle";
        case ConstraintCause::Quality:
            return "the mesh has no place for an EOL vertex: a corner, a pin, a vertex of another feature or "
                   "a thin face is there";
        case ConstraintCause::OffPlane:
            return "the mesh has a place for an EOL vertex only beside the line where the cloth passes over "
                   "the feature";
        case ConstraintCause::Blocked:
            return "the path ahead of its EOL vertices could not be cleared, or leads beyond the cloth's "
                   "border";
        case ConstraintCause::Gathering:
            return "the cloth is compressed along the feature and wants to leave it in pleats";
        case ConstraintCause::GivenUp:
            return "an attempt at the step with EOL vertices there failed";
        case ConstraintCause::Released:
            return "the contact was an EOL vertex until this step";
        case ConstraintCause::NoDirection:
            return "no direction leads away from the feature there";
        case ConstraintCause::AlongBorder:
            return "the feature runs along the cloth's border";
        case ConstraintCause::EdgeOn:
            return "the cloth stands on the feature edge-on";
        case ConstraintCause::ClothCorner:
            return "the contact is at a corner of the cloth";
        case ConstraintCause::OtherFeature:
            return "its vertex is on another feature of the same obstacle";
        case ConstraintCause::OtherObstacle:
            return "its vertex is on a feature of another obstacle";
    }
    return "";
}

std::string format_share(const std::optional<double>& share)
{
    return share ? fmt::format("{:.4g} %", 100.0 * *share) : "no contacts";
}

std::string feature_rows_html(const FeatureTotals& features)
{
    std::string html = feature_row("EOL vertex", features.eol,
                                   "the cloth slides over the feature through a vertex that lies on it");
    for (std::size_t k = 0; k < kConstraintCauses; ++k) {
        const auto cause = static_cast<ConstraintCause>(k);
        if (features.by_cause[k] == 0) continue;
        html += feature_row(
            fmt::format("row: {}", to_string(cause)), features.by_cause[k],
            std::string(explain(cause)) + (counts_in_share(cause) ? "" : " (not counted in the EOL share)"));
    }
    return html;
}

}  // namespace arris
