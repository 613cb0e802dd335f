// SPDX-License-Identifier: GPL-3.0-or-later
// Cloth is compressible. Where obstacles leave less room than the stand-offs of both, the contacts of the
// cloth between them no longer keep a distance. Each presses with a force instead,
//
//   F = E A (t - d) / t,   d < t,
//
// with the compression modulus E (Pa), the cloth's area A at the contact, the stand-off t and the distance d
// at the step's end. In the velocity solve this is a row with a compliance of its own, and friction has its
// force. Two plates in a gap g hold 2 mu A E (1 - g / (2 t)). At t / 50 it is a constraint again. A vertex is
// squeezed while its opposite contacts leave too little room; contacts of edges, faces and layers stay so as
// long as they press. What presses against squeezed cloth is squeezed, too. Past the rim of a gap a vertex
// takes the plane of its squeezed edge there: a slanted plane would hold cloth back at the entry, or throw it
// out.
//
// All other contacts keep their distance: a load of p Pa on one side squeezes the cloth by only p / E t, 2e-4
// t under its own weight.
#pragma once

#include <optional>
#include <vector>

#include "solver/contact/contacts.h"

namespace arris {

/// Least thickness of squeezed cloth, as a share of the stand-off.
inline constexpr double kLeastThickness = 0.02;

/// The cloth as a cushion between obstacles.
struct Cushion {
    std::vector<double> modulus;  ///< E, Pa, by vertex
    std::vector<double> area;     ///< m^2, by vertex
};

Cushion make_cushion(const Materials& materials, const ClothMesh& mesh, const ClothElements& elements);

/// Lets the cloth press as a spring at this contact. False where it does already, or where the contact keeps
/// the least thickness.
bool squeeze(const Cushion& cushion, const Carriers& carriers, const Prediction& prediction,
             Contact& contact);

/// Result of `squeeze_contacts`: whether a contact has changed, and a vertex (index) without any room.
struct Squeezed {
    bool is_changed = false;
    std::optional<int> overconstrained;
};

/// Squeezes the cloth at edges, faces and layers where it was squeezed in the last step, at opposite contacts
/// of one element with less room than both stand-offs, and at vertices beside squeezed edges. Only two planes
/// that face each other exactly can leave less room than the least thickness: between others the vertex could
/// slip out sideways.
Squeezed squeeze_contacts(const Cushion& cushion, const Carriers& carriers, const Prediction& prediction,
                          std::vector<Contact>& contacts);

/// Contacts that keep the least thickness where the cloth begins the step with at most 1 / kStayRatio of it.
std::vector<Contact> expect_floors(const Carriers& carriers, const Prediction& prediction,
                                   const std::vector<Contact>& contacts);

/// Contacts, not there yet, that keep the least thickness where `world` goes below it.
std::vector<Contact> find_floors(const Carriers& carriers, const Prediction& prediction,
                                 const std::vector<Contact>& contacts, const std::vector<Vec3>& world);

/// Rows of the velocity solve, ascending, whose squeezed cloth has less than the least thickness where it is
/// at `world`.
std::vector<int> list_too_thin(const Carriers& carriers, const std::vector<Contact>& contacts,
                               const std::vector<Vec3>& world);

/// Elastic energy of squeezed cloth, J: at the step's end where the cloth is at `world`, less that at its
/// start.
double energy_stored(const Carriers& carriers, const std::vector<Contact>& contacts,
                     const std::vector<Vec3>& world);

}  // namespace arris
