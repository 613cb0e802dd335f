// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/usd/usda_transform.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/usd/usda_scanner.h"
#include "geometry/tolerances.h"
#include "geometry/vectors.h"

namespace arris {
namespace {

using Kind = UsdOperation::Kind;
using Placement4 = Eigen::Matrix4d;
using Values = std::array<double, 16>;

struct KnownOperation {
    std::string_view name;
    Kind kind;
    std::string_view axes = "";
};

constexpr std::array<KnownOperation, 19> kOperations = {{{"translate", Kind::Translate},
                                                         {"translateX", Kind::Translate, "X"},
                                                         {"translateY", Kind::Translate, "Y"},
                                                         {"translateZ", Kind::Translate, "Z"},
                                                         {"scale", Kind::Scale},
                                                         {"scaleX", Kind::Scale, "X"},
                                                         {"scaleY", Kind::Scale, "Y"},
                                                         {"scaleZ", Kind::Scale, "Z"},
                                                         {"rotateX", Kind::Rotate, "X"},
                                                         {"rotateY", Kind::Rotate, "Y"},
                                                         {"rotateZ", Kind::Rotate, "Z"},
                                                         {"rotateXYZ", Kind::Rotate, "XYZ"},
                                                         {"rotateXZY", Kind::Rotate, "XZY"},
                                                         {"rotateYXZ", Kind::Rotate, "YXZ"},
                                                         {"rotateYZX", Kind::Rotate, "YZX"},
                                                         {"rotateZXY", Kind::Rotate, "ZXY"},
                                                         {"rotateZYX", Kind::Rotate, "ZYX"},
                                                         {"orient", Kind::Orient},
                                                         {"transform", Kind::Transform}}};

std::optional<UsdOperation> make_operation(std::string_view name)
{
    for (const KnownOperation& known : kOperations)
        if (known.name == name) return UsdOperation{std::string(known.axes), known.kind, false, {}, {}};
    return std::nullopt;
}

/// Numbers in a value: a lone one, a tuple, or four tuples of four.
std::vector<double> read_numbers(const InputFile& file, const UsdOperation& operation, const UsdPlace& place)
{
    UsdScanner scan(file, place);
    std::vector<double> numbers;
    if (operation.kind == Kind::Transform) {
        scan.require('(');
        for (int row = 0; row < 4; ++row) {
            if (row > 0) scan.require(',');
            scan.take_tuple(4, numbers);
        }
        scan.require(')');
    } else if (operation.axes.size() == 1) {
        numbers.push_back(scan.take_number());
    } else {
        scan.take_tuple(operation.kind == Kind::Orient ? 4 : 3, numbers);
    }
    for (const double number : numbers)
        if (!std::isfinite(number)) scan.refuse(fmt::format("{}; allowed: finite numbers", number));
    if (operation.kind == Kind::Orient &&
        !(std::hypot(numbers[0], numbers[1], std::hypot(numbers[2], numbers[3])) > 0.0))
        scan.refuse("a quaternion of length 0; allowed: any other");
    return numbers;
}

Mat3 turn_about(char axis, double degrees)
{
    const double angle = degrees * std::numbers::pi / 180.0;
    return Eigen::AngleAxisd(angle, Vec3::Unit(axis - 'X')).toRotationMatrix();
}

Eigen::Quaterniond to_quaternion(const Values& values)
{
    return Eigen::Quaterniond(values[0], values[1], values[2], values[3]).normalized();
}

/// The numbers of a translation or scale, of which one axis may be given.
Vec3 to_vector(const UsdOperation& operation, const Values& values)
{
    if (operation.axes.empty()) return {values[0], values[1], values[2]};
    Vec3 vector = Vec3::Constant(operation.kind == Kind::Scale ? 1.0 : 0.0);
    vector[operation.axes[0] - 'X'] = values[0];
    return vector;
}

Placement4 to_matrix(const UsdOperation& operation, const Values& values)
{
    Placement4 matrix = Placement4::Identity();
    switch (operation.kind) {
        case Kind::Translate:
            matrix.topRightCorner<3, 1>() = to_vector(operation, values);
            break;
        case Kind::Scale:
            matrix.topLeftCorner<3, 3>() = to_vector(operation, values).asDiagonal();
            break;
        case Kind::Rotate:
            // The first axis turns first.
            for (std::size_t k = 0; k < operation.axes.size(); ++k)
                matrix.topLeftCorner<3, 3>() =
                    Mat3(turn_about(operation.axes[k], values[k]) * matrix.topLeftCorner<3, 3>());
            break;
        case Kind::Orient:
            matrix.topLeftCorner<3, 3>() = to_quaternion(values).toRotationMatrix();
            break;
        case Kind::Transform:
            // The file's matrix is for row vectors: rows follow each other.
            for (int k = 0; k < 16; ++k) matrix(k % 4, k / 4) = values[k];
            break;
    }
    return matrix;
}

Values interpolate(const UsdOperation& operation, double time_code)
{
    const std::vector<double>& codes = operation.time_codes;
    const auto after = std::upper_bound(codes.begin(), codes.end(), time_code);
    if (after == codes.begin()) return operation.values.front();
    const auto last = static_cast<std::size_t>(after - codes.begin()) - 1;
    if (after == codes.end() || !(time_code > codes[last])) return operation.values[last];
    const double share = (time_code - codes[last]) / (codes[last + 1] - codes[last]);
    const Values &a = operation.values[last], &b = operation.values[last + 1];
    if (operation.kind == Kind::Orient) {
        const Eigen::Quaterniond q = to_quaternion(a).slerp(share, to_quaternion(b));
        return {q.w(), q.x(), q.y(), q.z()};
    }
    Values values;
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = (1.0 - share) * a[k] + share * b[k];
    return values;
}

/// Reads the operations of one prim.
class OperationReader {
  public:
    OperationReader(const InputFile& file, const UsdPrim& prim, std::string path)
        : file_(file), prim_(prim), path_(std::move(path))
    {
    }

    UsdOperation read(std::string_view entry) const
    {
        constexpr std::string_view kInverse = "!invert!", kPrefix = "xformOp:";
        const bool is_inverse = entry.starts_with(kInverse);
        if (is_inverse) entry.remove_prefix(kInverse.size());
        const std::string_view rest = entry.substr(std::min(entry.size(), kPrefix.size()));
        std::optional<UsdOperation> operation = make_operation(rest.substr(0, rest.find(':')));
        if (!entry.starts_with(kPrefix) || !operation)
            refuse(
                entry,
                "is not known; allowed: xformOp:translate, scale, rotateX to rotateZYX, orient, transform");
        operation->is_inverse = is_inverse;
        const UsdAttribute* attribute = prim_.find(std::string(entry));
        if (attribute == nullptr || (!attribute->value && attribute->samples.empty()))
            refuse(entry, "has no value");
        if (attribute->samples.empty()) {
            add(*attribute->value, *operation, entry);
        } else {
            for (const UsdSample& sample : attribute->samples) {
                operation->time_codes.push_back(sample.time_code);
                add(sample.value, *operation, entry);
            }
        }
        return *std::move(operation);
    }

  private:
    void add(const UsdValue& value, UsdOperation& operation, std::string_view entry) const
    {
        const std::vector<double> numbers = read_numbers(file_, operation, value.place);
        Values values{};
        std::copy(numbers.begin(), numbers.end(), values.begin());
        const Placement4 matrix = to_matrix(operation, values);
        if (operation.kind == Kind::Transform &&
            !((matrix.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().sum() <= kThreeDigits))
            refuse(entry, "is a projection; allowed: a last column of 0, 0, 0, 1");
        if (operation.is_inverse && !(std::abs(matrix.determinant()) > 0.0)) refuse(entry, "has no inverse");
        operation.values.push_back(values);
    }

    [[noreturn]] void refuse(std::string_view entry, const std::string& why) const
    {
        throw InputError(
            fmt::format("{}: prim {}: {} {}", file_.path(), one_line(path_), one_line(excerpt(entry)), why));
    }

    const InputFile& file_;
    const UsdPrim& prim_;
    std::string path_;
};

}  // namespace

UsdTransform::UsdTransform(const InputFile& file, const UsdStage& stage, int prim)
{
    bool is_reset = false;
    for (; prim >= 0 && !is_reset; prim = stage.prims[prim].parent) {
        const OperationReader reader(file, stage.prims[prim], stage.path(prim));
        std::vector<UsdOperation> own;
        for (const std::string& entry : stage.prims[prim].xform_order) {
            if (entry == "!resetXformStack!") {
                is_reset = true;
                own.clear();
            } else {
                own.push_back(reader.read(entry));
            }
        }
        operations_.insert(operations_.begin(), own.begin(), own.end());
    }
    for (const UsdOperation& operation : operations_)
        time_codes_.insert(time_codes_.end(), operation.time_codes.begin(), operation.time_codes.end());
    std::sort(time_codes_.begin(), time_codes_.end());
    time_codes_.erase(std::unique(time_codes_.begin(), time_codes_.end()), time_codes_.end());
}

Placement4 UsdTransform::at(double time_code) const
{
    Placement4 placement = Placement4::Identity();
    for (const UsdOperation& operation : operations_) {
        const Placement4 matrix = to_matrix(operation, interpolate(operation, time_code));
        placement = placement * (operation.is_inverse ? Placement4(matrix.inverse()) : matrix);
    }
    return placement;
}

}  // namespace arris
