// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vectors.h"

namespace arris {

/// An object that another one (a component) or the build (an item) places.
struct ThreeMfReference {
    std::string object;  ///< its id
    std::string path;    ///< name of the part that has the object; empty: the part of this reference
    Mat3 turn = Mat3::Identity();
    Vec3 shift = Vec3::Zero();  ///< in the unit of the part of this reference
};

/// A mesh, or references to other objects.
struct ThreeMfObject {
    std::string type = "model";
    std::vector<Vec3> points;  ///< in the part's unit
    std::vector<Face> faces;
    std::vector<ThreeMfReference> components;
    std::string foreign;  ///< an element that gives the object a shape, but is not of the core specification
    std::string unread;   ///< an element of a vendor's extension, which the file does not require
};

/// A model part of a 3MF package.
struct ThreeMfPart {
    double metres_per_unit = 1e-3;
    std::map<std::string, ThreeMfObject> objects;  ///< by id
    std::vector<ThreeMfReference> items;           ///< of the build
};

/// Reads a part of a 3MF package (3D Manufacturing Format core specification 1.3, production extension 1.1).
/// Throws InputError, without the part's name: for text that is no XML or no model; a unit, number, transform
/// or index that is not allowed; and a required extension that may change shapes, other than production.
ThreeMfPart read_three_mf_part(std::string_view xml);

}  // namespace arris
