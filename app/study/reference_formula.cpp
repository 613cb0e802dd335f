// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/study/reference_formula.h"

#include <fmt/format.h>
#include <muParser.h>

#include <cmath>
#include <numbers>

#include "app/text/printable.h"
#include "geometry/input_error.h"

namespace arris {
namespace {

mu::Parser make_parser(const std::string& formula, double& t)
{
    mu::Parser parser;
    parser.DefineConst("pi", std::numbers::pi);
    parser.DefineVar("t", &t);
    parser.SetExpr(formula);
    return parser;
}

}  // namespace

std::string formula_error(const std::string& formula)
{
    double t = 0.0;
    try {
        make_parser(formula, t).Eval();
    } catch (const mu::Parser::exception_type& error) {
        return fmt::format("is not a formula in t: {}", printable(error.GetMsg(), 200));
    }
    return "";
}

std::vector<double> evaluate_formula(const std::string& formula, const std::vector<double>& times)
{
    double t = 0.0;
    const mu::Parser parser = make_parser(formula, t);
    std::vector<double> values;
    for (const double time : times) {
        t = time;
        values.push_back(parser.Eval());
        if (!std::isfinite(values.back()))
            throw InputError(
                fmt::format("error.reference = \"{}\": is {} at t = {} s; allowed: a finite number",
                            printable(formula, 200), values.back(), time));
    }
    return values;
}

}  // namespace arris
