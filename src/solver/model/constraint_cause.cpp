// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/model/constraint_cause.h"

namespace arris {

const char* to_string(ConstraintCause cause)
{
    switch (cause) {
        case ConstraintCause::New:
            return "new";
        case ConstraintCause::NotCrossing:
            return "not_crossing";
        case ConstraintCause::AtEol:
            return "at_eol";
        case ConstraintCause::BesideEol:
            return "beside_eol";
        case ConstraintCause::FlatBehind:
            return "flat_behind";
        case ConstraintCause::Unresolved:
            return "unresolved";
        case ConstraintCause::NearBorder:
            return "near_border";
        case ConstraintCause::BorderAhead:
            return "border_ahead";
        case ConstraintCause::Guard:
            return "guard";
        case ConstraintCause::Quality:
            return "quality";
        case ConstraintCause::OffPlane:
            return "off_plane";
        case ConstraintCause::Blocked:
            return "blocked";
        case ConstraintCause::Gathering:
            return "gathering";
        case ConstraintCause::GivenUp:
            return "given_up";
        case ConstraintCause::Released:
            return "released";
        case ConstraintCause::NoDirection:
            return "no_direction";
        case ConstraintCause::AlongBorder:
            return "along_border";
        case ConstraintCause::EdgeOn:
            return "edge_on";
        case ConstraintCause::ClothCorner:
            return "cloth_corner";
        case ConstraintCause::OtherFeature:
            return "other_feature";
        case ConstraintCause::OtherObstacle:
            return "other_obstacle";
    }
    return "";
}

bool is_excluded(ConstraintCause cause)
{
    switch (cause) {
        case ConstraintCause::AtEol:
        case ConstraintCause::FlatBehind:
        case ConstraintCause::Unresolved:
        case ConstraintCause::Gathering:
        case ConstraintCause::NearBorder:
        case ConstraintCause::NoDirection:
        case ConstraintCause::AlongBorder:
        case ConstraintCause::EdgeOn:
        case ConstraintCause::ClothCorner:
        case ConstraintCause::OtherObstacle:
            return true;
        default:
            return false;
    }
}

bool counts_in_share(ConstraintCause cause)
{
    return cause != ConstraintCause::New && !is_excluded(cause);
}

}  // namespace arris
