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
            return "has just come: a contact is a row for its first step";
        case RowCause::NotCrossing:
            return "the cloth does not pass over its feature there, so that a vertex has no place";
        case RowCause::AtEol:
            return "is the contact of an EOL vertex, seen on what is beside it";
        case RowCause::BesideEol:
            return "an EOL vertex has its place already, but the cloth touches the feature beside it";
        case RowCause::FlatBehind:
            return "follows, flat on a face beside its feature, a fold that has flown off that";
        case RowCause::NearBorder:
            return "is so near the cloth's border that a vertex would slide off it at once";
        case RowCause::BorderAhead:
            return "slides so fast towards the cloth's border that it would be there in a few steps";
        case RowCause::Guard:
            return "the mesh it needs would strain the cloth, or an obstacle is in the way";
        case RowCause::Quality:
            return "the mesh has no place for it: a corner, a pin, another feature's vertices, or faces too "
                   "thin";
        case RowCause::OffPlane:
            return "the mesh could have a vertex only off the place where the cloth passes over the feature";
        case RowCause::Blocked:
            return "what is ahead of its vertices could not be cleared, or is beyond the cloth's border";
        case RowCause::GivenUp:
            return "with EOL vertices there no such step could be made";
        case RowCause::Released:
            return "was an EOL vertex until this step";
        case RowCause::NoDirection:
            return "there is no direction that leads away from its feature";
        case RowCause::AlongBorder:
            return "its feature runs along the cloth's border";
        case RowCause::EdgeOn:
            return "the cloth stands on its feature on edge";
        case RowCause::ClothCorner:
            return "is at a corner of the cloth";
        case RowCause::OtherFeature:
            return "its vertex is on another feature of the same obstacle";
        case RowCause::OtherObstacle:
            return "its vertex is on a feature of another obstacle";
    }
    return "";
}

std::string format_share(const std::optional<double>& share)
{
    return share ? fmt::format("{:.4g} %", 100.0 * *share) : "none pressed";
}

std::string feature_rows_html(const FeatureTotals& features)
{
    std::string html =
        feature_row("EOL vertex", features.eol,
                    "the cloth has a vertex on the feature, and slides over it through that vertex");
    for (std::size_t k = 0; k < kRowCauses; ++k) {
        const auto cause = static_cast<RowCause>(k);
        if (features.by_cause[k] == 0) continue;
        html += feature_row(
            fmt::format("row: {}", to_string(cause)), features.by_cause[k],
            std::string(explain(cause)) + (counts_in_share(cause) ? "" : " (left out of the share)"));
    }
    return html;
}

}  // namespace arris
