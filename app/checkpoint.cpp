// SPDX-License-Identifier: GPL-3.0-or-later
// Layout, little-endian: magic, length-prefixed version, length-prefixed body, CRC-32 of the body. In the
// body every array is a 64-bit count and its elements.
#include "app/checkpoint.h"

#include <fmt/format.h>
#include <zlib.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <type_traits>
#include <utility>

#include "app/atomic_file.h"
#include "app/printable.h"
#include "app/version.h"
#include "geometry/input_error.h"
#include "geometry/mesh_topology.h"

namespace arris {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are stored as they are in memory");

constexpr std::string_view kMagic = "ARRIS checkpoint\n";

class Writer {
  public:
    template <typename Number>
    void number(Number value)
    {
        static_assert(std::is_arithmetic_v<Number>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void text(std::string_view value)
    {
        number<std::uint64_t>(value.size());
        bytes_.append(value);
    }
    template <typename Item, typename Write>
    void list(const std::vector<Item>& items, const Write& write)
    {
        number<std::uint64_t>(items.size());
        for (const Item& item : items) write(item);
    }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

class Reader {
  public:
    Reader(std::string_view bytes, const std::string& path) : left_(bytes), path_(path) {}

    template <typename Number>
    Number number()
    {
        Number value;
        const std::string_view bytes = take(sizeof value);
        std::memcpy(&value, bytes.data(), sizeof value);
        return value;
    }
    std::string text() { return std::string(take(number<std::uint64_t>())); }
    template <typename Item, typename Read>
    std::vector<Item> list(std::size_t item_size, const Read& read)
    {
        const std::uint64_t count = number<std::uint64_t>();
        if (count > left_.size() / item_size) fail("is truncated or damaged");
        std::vector<Item> items;
        items.reserve(count);
        for (std::uint64_t k = 0; k < count; ++k) items.push_back(read());
        return items;
    }
    std::string_view take(std::uint64_t size)
    {
        if (size > left_.size()) fail("is truncated or damaged");
        const std::string_view bytes = left_.substr(0, size);
        left_.remove_prefix(size);
        return bytes;
    }
    bool is_at_end() const { return left_.empty(); }
    [[noreturn]] void fail(std::string_view what) const
    {
        throw InputError(fmt::format("{}: {}", printable(path_), what));
    }

  private:
    std::string_view left_;
    std::string path_;
};

void write_vectors(Writer& out, const std::vector<Vec3>& vectors)
{
    out.list(vectors, [&](const Vec3& v) {
        for (const double c : v) out.number(c);
    });
}

std::vector<Vec3> read_vectors(Reader& in)
{
    return in.list<Vec3>(3 * sizeof(double), [&] {
        Vec3 v;
        for (double& c : v) c = in.number<double>();
        return v;
    });
}

void write_state(Writer& out, const State& state)
{
    out.number(state.time);
    out.number(state.step);
    out.list(state.mesh.material, [&](const Vec2& X) {
        for (const double c : X) out.number(c);
    });
    write_vectors(out, state.mesh.world);
    out.list(state.mesh.faces, [&](const Face& face) {
        for (const int v : face) out.number(static_cast<std::int32_t>(v));
    });
    out.list(state.ids, [&](std::uint32_t id) { out.number(id); });
    out.number(state.next_id);
    write_vectors(out, state.velocity);
    out.number(state.previous_dt);
    write_vectors(out, state.previous_world);
    write_vectors(out, state.previous_velocity);
    out.list(state.anchors, [&](const PinAnchor& anchor) {
        out.number(anchor.pin);
        out.number(anchor.vertex_id);
        for (const double c : anchor.origin) out.number(c);
    });
    out.list(state.active, [&](const ActiveBound& bound) {
        out.number(bound.vertex_id);
        out.number(bound.multiplier);
    });
}

State read_state(Reader& in)
{
    State state;
    state.time = in.number<double>();
    state.step = in.number<std::int64_t>();
    state.mesh.material = in.list<Vec2>(2 * sizeof(double), [&] {
        const double u = in.number<double>();
        return Vec2(u, in.number<double>());
    });
    state.mesh.world = read_vectors(in);
    state.mesh.faces = in.list<Face>(3 * sizeof(std::int32_t), [&] {
        Face face;
        for (int& v : face) v = in.number<std::int32_t>();
        return face;
    });
    state.ids = in.list<std::uint32_t>(sizeof(std::uint32_t), [&] { return in.number<std::uint32_t>(); });
    state.next_id = in.number<std::uint32_t>();
    state.velocity = read_vectors(in);
    state.previous_dt = in.number<double>();
    state.previous_world = read_vectors(in);
    state.previous_velocity = read_vectors(in);
    state.anchors = in.list<PinAnchor>(2 * sizeof(std::uint32_t) + 3 * sizeof(double), [&] {
        PinAnchor anchor;
        anchor.pin = in.number<std::uint32_t>();
        anchor.vertex_id = in.number<std::uint32_t>();
        for (double& c : anchor.origin) c = in.number<double>();
        return anchor;
    });
    state.active = in.list<ActiveBound>(sizeof(std::uint32_t) + sizeof(double), [&] {
        const std::uint32_t id = in.number<std::uint32_t>();
        return ActiveBound{id, in.number<double>()};
    });
    return state;
}

/// What no run could have written; empty if nothing.
std::string find_defect(const Checkpoint& checkpoint)
{
    const State& state = checkpoint.state;
    const std::size_t n = state.mesh.world.size();
    if (state.ids.size() != n || state.velocity.size() != n || state.previous_world.size() != n ||
        state.previous_velocity.size() != n || state.mesh.material.size() != n)
        return "its arrays differ in length";
    for (std::size_t v = 1; v < n; ++v)
        if (state.ids[v] <= state.ids[v - 1]) return "vertex ids do not ascend";
    for (std::size_t v = 0; v < n; ++v)
        if (!state.velocity[v].allFinite() || !state.previous_world[v].allFinite() ||
            !state.previous_velocity[v].allFinite())
            return fmt::format("vertex {} is not finite", v);
    for (std::size_t k = 1; k < state.active.size(); ++k)
        if (state.active[k].vertex_id <= state.active[k - 1].vertex_id) return "active bounds do not ascend";
    for (std::size_t k = 0; k < state.anchors.size(); ++k) {
        const PinAnchor& anchor = state.anchors[k];
        if (!anchor.origin.allFinite()) return fmt::format("anchor {} is not finite", k);
        if (k > 0 && std::pair(anchor.pin, anchor.vertex_id) <=
                         std::pair(state.anchors[k - 1].pin, state.anchors[k - 1].vertex_id))
            return "anchors do not ascend";
    }
    if (!std::isfinite(state.time) || !(state.previous_dt >= 0.0) ||
        !std::isfinite(checkpoint.position.begin) || checkpoint.position.begin < 0.0 ||
        checkpoint.position.done < 0 || checkpoint.frames < 0 || checkpoint.rows < 1)
        return "its times or counts cannot be";
    return validate(state.mesh);
}

std::string read_bytes(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    if (!in || !std::filesystem::is_regular_file(path))
        throw InputError(fmt::format("{}: there is no checkpoint to resume from", printable(path)));
    return std::string(std::istreambuf_iterator<char>(in), {});
}

std::uint32_t checksum(std::string_view bytes)
{
    return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

void write_checkpoint(const std::string& path, const Checkpoint& checkpoint)
{
    Writer body;
    body.text(checkpoint.source.path);
    body.text(checkpoint.source.text);
    body.list(checkpoint.source.overrides, [&](const std::string& item) { body.text(item); });
    body.list(checkpoint.warnings, [&](const std::string& item) { body.text(item); });
    write_state(body, checkpoint.state);
    body.number(checkpoint.position.begin);
    body.number(checkpoint.position.done);
    body.number(checkpoint.frames);
    body.number(checkpoint.rows);

    Writer file;
    file.text(kVersion);
    file.text(body.bytes());
    file.number(checksum(body.bytes()));
    write_atomically(path, std::string(kMagic) + file.bytes());
}

Checkpoint read_checkpoint(const std::string& path)
{
    const std::string bytes = read_bytes(path);
    if (!bytes.starts_with(kMagic))
        throw InputError(fmt::format("{}: is not a checkpoint of arris", printable(path)));
    Reader file(std::string_view(bytes).substr(kMagic.size()), path);
    const std::string version = file.text();
    if (version != kVersion)
        file.fail(
            fmt::format("was written by version {}; this is version {}", printable(version, 40), kVersion));
    const std::string body = file.text();
    if (file.number<std::uint32_t>() != checksum(body)) file.fail("is damaged: its checksum differs");

    if (!file.is_at_end()) file.fail("is damaged: it is longer than it says");
    Reader in(body, path);
    Checkpoint checkpoint;
    checkpoint.source.path = in.text();
    checkpoint.source.text = in.text();
    checkpoint.source.overrides = in.list<std::string>(sizeof(std::uint64_t), [&] { return in.text(); });
    checkpoint.warnings = in.list<std::string>(sizeof(std::uint64_t), [&] { return in.text(); });
    checkpoint.state = read_state(in);
    checkpoint.position.begin = in.number<double>();
    checkpoint.position.done = in.number<std::int64_t>();
    checkpoint.frames = in.number<std::int64_t>();
    checkpoint.rows = in.number<std::int64_t>();
    if (!in.is_at_end()) in.fail("is damaged: it is longer than it says");
    if (const std::string defect = find_defect(checkpoint); !defect.empty()) in.fail("is damaged: " + defect);
    return checkpoint;
}

}  // namespace arris
