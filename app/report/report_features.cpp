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

const char* explain(RowCause cause)
{
    switch (cause) {
        case RowCause::New:
            return "the contact is new: every contact is a row in its first step";
        case RowCause::NotCrossing:
            return "the cloth does not pass over the feature there, so there is no place for an EOL vertex";
        case RowCause::AtEol:
            return "repeats the contact of an EOL vertex on an edge or face beside that vertex";
        case RowCause::BesideEol:
            return "its place is taken by an EOL vertex of the feature, but the cloth touches the feature "
                   "elsewhere";
        case RowCause::FlatBehind:
            return "the cloth lies flat on a face beside the feature, behind a fold that has left the "
                   "feature";
        case RowCause::NearBorder:
            return "the cloth's border is so near that it would slide past an EOL vertex at once";
        case RowCause::BorderAhead:
            return "the cloth's border moves towards the contact and would reach it within a few steps";
        case RowCause::Guard:
            return "the mesh change for an EOL vertex would strain the cloth or pass through an obstacle";
        case RowCause::Quality:
            return "the mesh has no place for an EOL vertex: a corner, a pin, a vertex of another feature or "
                   "a thin face is there";
        case RowCause::OffPlane:
            return "the mesh has a place for an EOL vertex only beside the line where the cloth passes over "
                   "the feature";
        case RowCause::Blocked:
            return "the path ahead of its EOL vertices could not be cleared, or leads beyond the cloth's "
                   "border";
        case RowCause::Gathering:
            return "the cloth is compressed along the feature and wants to leave it in pleats";
        case RowCause::GivenUp:
            return "an attempt at the step with EOL vertices there failed";
        case RowCause::Released:
            return "the contact was an EOL vertex until this step";
        case RowCause::NoDirection:
            return "no direction leads away from the feature there";
        case RowCause::AlongBorder:
            return "the feature runs along the cloth's border";
        case RowCause::EdgeOn:
            return "the cloth stands on the feature edge-on";
        case RowCause::ClothCorner:
            return "the contact is at a corner of the cloth";
        case RowCause::OtherFeature:
            return "its vertex is on another feature of the same obstacle";
        case RowCause::OtherObstacle:
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
    for (std::size_t k = 0; k < kRowCauses; ++k) {
        const auto cause = static_cast<RowCause>(k);
        if (features.by_cause[k] == 0) continue;
        html += feature_row(
            fmt::format("row: {}", to_string(cause)), features.by_cause[k],
            std::string(explain(cause)) + (counts_in_share(cause) ? "" : " (not counted in the EOL share)"));
    }
    return html;
}

}  // namespace arris
