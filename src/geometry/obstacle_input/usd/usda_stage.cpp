// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/obstacle_input/usd/usda_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "geometry/input_error.h"
#include "geometry/mesh_text.h"
#include "geometry/obstacle_input/formats/mesh_file_limits.h"

namespace arris {
namespace {

constexpr std::size_t kDeepestPrim = 200;
constexpr std::string_view kSamples = ".timeSamples";

template <std::size_t size>
bool is_in(const std::array<std::string_view, size>& words, std::string_view word)
{
    return std::find(words.begin(), words.end(), word) != words.end();
}

constexpr std::array<std::string_view, 5> kListEdits = {"prepend", "append", "add", "delete", "reorder"};
constexpr std::array<std::string_view, 4> kAttributeWords = {"custom", "uniform", "varying", "config"};
// What a prim may take from elsewhere.
constexpr std::array<std::string_view, 5> kCompositions = {"references", "payload", "inherits", "specializes",
                                                           "clips"};

class StageReader {
  public:
    explicit StageReader(const InputFile& file) : scan_(file) {}

    UsdStage read()
    {
        if (scan_.next() == '(') read_layer_metadata();
        for (char c = scan_.next(); c != '\0'; c = scan_.next()) {
            if (c == ';') {
                scan_.take(c);
            } else if (c == '}' && !open_.empty()) {
                scan_.take(c);
                open_.pop_back();
            } else {
                read_statement();
            }
        }
        if (!open_.empty())
            scan_.refuse(fmt::format("the file ends inside prim {}", one_line(stage_.path(open_.back()))));
        if (const auto rate = codes_per_second_ ? codes_per_second_ : frames_per_second_) {
            if (!(*rate > 0.0 && std::isfinite(*rate)))
                scan_.refuse(fmt::format("timeCodesPerSecond is {}; allowed: a number > 0", *rate));
            stage_.time_codes_per_second = *rate;
        }
        return std::move(stage_);
    }

  private:
    /// Reads metadata in parentheses; `read_value` takes what follows `key =`.
    template <class ReadValue>
    void read_metadata(ReadValue read_value)
    {
        scan_.require('(');
        while (!scan_.take(')')) {
            const char c = scan_.next();
            if (c == ';' || c == ',') {
                scan_.take(c);
            } else if (c == '"' || c == '\'') {
                scan_.take_text();
            } else {
                std::string key = scan_.take_word();
                if (is_in(kListEdits, key)) key = scan_.take_word();
                scan_.require('=');
                read_value(key);
                if (scan_.next() == '(') scan_.skip_value();  // the offset of a layer
            }
        }
    }

    void read_layer_metadata()
    {
        read_metadata([&](const std::string& key) {
            if (key == "metersPerUnit")
                read_unit();
            else if (key == "upAxis")
                read_up();
            else if (key == "timeCodesPerSecond")
                codes_per_second_ = scan_.take_number();
            else if (key == "framesPerSecond")
                frames_per_second_ = scan_.take_number();
            else if (key == "subLayers")
                read_layers();
            else
                scan_.skip_value();
        });
    }

    void read_unit()
    {
        const double unit = scan_.take_number();
        if (!(unit > 0.0 && std::isfinite(unit)))
            scan_.refuse(fmt::format("metersPerUnit is {}; allowed: a number > 0", unit));
        stage_.metres_per_unit = unit;
    }

    void read_up()
    {
        const std::string axis = scan_.take_text();
        if (axis != "Y" && axis != "Z")
            scan_.refuse(fmt::format("upAxis is \"{}\"; allowed: \"Y\", \"Z\"", one_line(excerpt(axis))));
        stage_.up = axis == "Y" ? 'y' : 'z';
    }

    void read_layers()
    {
        scan_.require('[');
        if (scan_.take(']')) return;
        scan_.refuse(
            "the file is made of several layers (subLayers); allowed: one, as `usdcat --flatten` writes");
    }

    void read_statement()
    {
        std::string word = scan_.take_word();
        if (word == "def" || word == "over" || word == "class")
            read_prim(word == "def");
        else if (word == "variantSet")
            read_variants();
        else
            read_property(std::move(word));
    }

    // Prims that are not defined, only overridden or inherited from, are not shown.
    void read_prim(bool is_defined)
    {
        UsdPrim prim;
        if (const char c = scan_.next(); c != '"' && c != '\'') prim.type = scan_.take_word();
        prim.name = scan_.take_text();
        prim.parent = open_.empty() ? -1 : open_.back();
        if (scan_.next() == '(')
            read_metadata([&](const std::string& key) {
                const bool is_empty = scan_.skip_value().is_blocked;
                if (!is_empty && prim.composition.empty() && is_in(kCompositions, key))
                    prim.composition = key;
            });
        if (scan_.next() != '{') scan_.require('{');
        if (!is_defined) {
            scan_.skip_value();
            return;
        }
        scan_.take('{');
        if (open_.size() == kDeepestPrim)
            scan_.refuse(fmt::format("more than {} prims within prims", kDeepestPrim));
        if (stage_.prims.size() == kMostNodes) scan_.refuse(fmt::format("more than {} prims", kMostNodes));
        open_.push_back(static_cast<int>(stage_.prims.size()));
        stage_.prims.push_back(std::move(prim));
    }

    void read_variants()
    {
        scan_.take_text();
        scan_.require('=');
        scan_.skip_value();
        if (!open_.empty()) stage_.prims[open_.back()].composition = "variantSet";
    }

    void read_property(std::string word)
    {
        UsdAttribute attribute;
        const bool is_order = word == "reorder";
        while (is_in(kListEdits, word) || is_in(kAttributeWords, word)) word = scan_.take_word();
        if (is_order) {
            attribute.name = word;
        } else {
            attribute.type = word;
            if (scan_.take('[')) {
                scan_.require(']');
                attribute.type += "[]";
            }
            attribute.name = scan_.take_word();
        }
        if (scan_.take('=')) read_value(std::move(attribute));
        if (scan_.next() == '(') scan_.skip_value();  // metadata
    }

    void read_value(UsdAttribute attribute)
    {
        const bool is_sampled = attribute.name.ends_with(kSamples);
        if (is_sampled) attribute.name.resize(attribute.name.size() - kSamples.size());
        const bool is_op = attribute.name.starts_with("xformOp:");
        UsdPrim* prim = open_.empty() ? nullptr : &stage_.prims[open_.back()];
        if (prim == nullptr || !(attribute.name == "points" || attribute.name == "xformOpOrder" || is_op)) {
            const bool is_skeleton =
                attribute.name.starts_with("skel:") || attribute.name.starts_with("primvars:skel:");
            if (prim != nullptr && is_skeleton) prim->has_skeleton = true;
            scan_.skip_value();
        } else if (attribute.name == "xformOpOrder") {
            prim->xform_order = read_names();
        } else {
            if (is_sampled)
                read_samples(attribute);
            else
                attribute.value = take_value();
            keep(*prim, std::move(attribute));
        }
    }

    // Default and samples of one attribute are two statements.
    static void keep(UsdPrim& prim, UsdAttribute attribute)
    {
        for (UsdAttribute& known : prim.attributes)
            if (known.name == attribute.name) {
                if (attribute.value) known.value = attribute.value;
                if (!attribute.samples.empty()) known.samples = std::move(attribute.samples);
                return;
            }
        prim.attributes.push_back(std::move(attribute));
    }

    std::optional<UsdValue> take_value()
    {
        const UsdPlace place = scan_.place();
        const UsdSkipped skipped = scan_.skip_value();
        if (skipped.is_blocked) return std::nullopt;
        return UsdValue{place, skipped.groups};
    }

    void read_samples(UsdAttribute& attribute)
    {
        scan_.require('{');
        while (!scan_.take('}')) {
            const double code = scan_.take_number();
            if (!std::isfinite(code))
                scan_.refuse(fmt::format("time code {}; allowed: finite numbers", code));
            scan_.require(':');
            const std::optional<UsdValue> value = take_value();
            if (!value)
                scan_.refuse(fmt::format("{} has no value at time code {}; allowed: one at each",
                                         one_line(excerpt(attribute.name)), code));
            attribute.samples.push_back({code, *value});
            if (scan_.next() != '}') scan_.require(',');
        }
        std::vector<UsdSample>& samples = attribute.samples;
        std::stable_sort(samples.begin(), samples.end(),
                         [](const auto& a, const auto& b) { return a.time_code < b.time_code; });
        for (std::size_t k = 1; k < samples.size(); ++k)
            if (!(samples[k].time_code > samples[k - 1].time_code))
                scan_.refuse(fmt::format("{} has two values at time code {}",
                                         one_line(excerpt(attribute.name)), samples[k].time_code));
    }

    std::vector<std::string> read_names()
    {
        std::vector<std::string> names;
        if (scan_.next() != '[') {
            scan_.skip_value();  // None
            return names;
        }
        scan_.take('[');
        while (!scan_.take(']')) {
            names.push_back(scan_.take_text());
            if (scan_.next() != ']') scan_.require(',');
        }
        return names;
    }

    UsdScanner scan_;
    UsdStage stage_;
    std::vector<int> open_;  // the prim being read and those above it
    std::optional<double> codes_per_second_, frames_per_second_;
};

void require_text(const InputFile& file)
{
    constexpr std::string_view kHead = "#usda";
    std::string head(std::min<std::uint64_t>(file.size(), 8), '\0');
    file.read(0, head.data(), head.size());
    if (head == "PXR-USDC" || head.starts_with("PK\x03\x04"))
        throw InputError(
            fmt::format("{}: is a binary USD file; allowed: USD text, as `usdcat {} -o body.usda` writes",
                        file.path(), file.path()));
    if (!head.starts_with(kHead))
        throw InputError(fmt::format("{}: is not a USD text: it does not begin with {}", file.path(), kHead));
}

std::string list(const UsdStage& stage, const std::vector<int>& meshes)
{
    std::string text;
    for (std::size_t k = 0; k < std::min(meshes.size(), kMostNotes); ++k)
        text += (k > 0 ? ", " : "") + stage.path(meshes[k]);
    return one_line(text) + (meshes.size() > kMostNotes ? ", ..." : "");
}

}  // namespace

const UsdAttribute* UsdPrim::find(const std::string& attribute) const
{
    for (const UsdAttribute& known : attributes)
        if (known.name == attribute) return &known;
    return nullptr;
}

std::string UsdStage::path(int prim) const
{
    std::string path;
    for (; prim >= 0; prim = prims[prim].parent) path = "/" + prims[prim].name + path;
    return path;
}

UsdStage read_usda_stage(const InputFile& file)
{
    require_text(file);
    return StageReader(file).read();
}

int find_usda_mesh(const InputFile& file, const UsdStage& stage, const std::optional<std::string>& path)
{
    const auto refuse = [&](const std::string& why) { throw InputError(file.path() + ": " + why); };
    std::vector<int> all, sampled, named;
    for (std::size_t k = 0; k < stage.prims.size(); ++k) {
        if (stage.prims[k].type != "Mesh") continue;
        const int prim = static_cast<int>(k);
        const UsdAttribute* points = stage.prims[k].find("points");
        all.push_back(prim);
        if (points != nullptr && !points->samples.empty()) sampled.push_back(prim);
        if (path && stage.path(prim) == *path) named.push_back(prim);
    }
    if (all.empty())
        refuse("has no Mesh that is defined in the file itself; `usdcat --flatten` takes in others");
    if (path && named.empty())
        refuse(fmt::format("has no Mesh {}; allowed: {}", one_line(*path), list(stage, all)));
    const std::vector<int>& found = path ? named : sampled.empty() ? all : sampled;
    if (found.size() > 1)
        refuse(fmt::format("has {} meshes{}: state `prim`; allowed: {}", found.size(),
                           sampled.empty() || path ? "" : " with samples in time", list(stage, found)));
    for (int prim = found[0]; prim >= 0; prim = stage.prims[prim].parent)
        if (const std::string& word = stage.prims[prim].composition; !word.empty())
            refuse(fmt::format(
                "prim {} has `{}`, which are not read; allowed: a flat file, as `usdcat --flatten` "
                "writes",
                one_line(stage.path(prim)), word));
    return found[0];
}

}  // namespace arris
