// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/model/row_cause.h"

namespace arris {

const char* to_string(RowCause cause)
{
    switch (cause) {
        case RowCause::New:
            return "new";
        case RowCause::NotCrossing:
            return "not_crossing";
        case RowCause::AtEol:
            return "at_eol";
        case RowCause::BesideEol:
            return "beside_eol";
        case RowCause::FlatBehind:
            return "flat_behind";
        case RowCause::NearBorder:
            return "near_border";
        case RowCause::BorderAhead:
            return "border_ahead";
        case RowCause::Guard:
            return "guard";
        case RowCause::Quality:
            return "quality";
        case RowCause::OffPlane:
            return "off_plane";
        case RowCause::Blocked:
            return "blocked";
        case RowCause::Gathering:
            return "gathering";
        case RowCause::GivenUp:
            return "given_up";
        case RowCause::Released:
            return "released";
        case RowCause::NoDirection:
            return "no_direction";
        case RowCause::AlongBorder:
            return "along_border";
        case RowCause::EdgeOn:
            return "edge_on";
        case RowCause::ClothCorner:
            return "cloth_corner";
        case RowCause::OtherFeature:
            return "other_feature";
        case RowCause::OtherObstacle:
            return "other_obstacle";
    }
    return "";
}

bool is_excluded(RowCause cause)
{
    switch (cause) {
        case RowCause::AtEol:
        case RowCause::FlatBehind:
        case RowCause::Gathering:
        case RowCause::NearBorder:
        case RowCause::NoDirection:
        case RowCause::AlongBorder:
        case RowCause::EdgeOn:
        case RowCause::ClothCorner:
        case RowCause::OtherObstacle:
            return true;
        default:
            return false;
    }
}

bool counts_in_share(RowCause cause)
{
    return cause != RowCause::New && !is_excluded(cause);
}

}  // namespace arris
