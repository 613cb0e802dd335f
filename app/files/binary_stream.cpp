// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/files/binary_stream.h"

#include <fmt/format.h>
#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>

#include "app/files/atomic_file.h"
#include "app/text/printable.h"
#include "geometry/input_error.h"

namespace arris {

std::uint32_t checksum(std::string_view bytes)
{
    return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void BinaryWriter::text(std::string_view value)
{
    number(static_cast<std::uint64_t>(value.size()));
    bytes_.append(value);
}

void BinaryWriter::vector(const Vec3& value)
{
    for (const double c : value) number(c);
}

void BinaryWriter::vectors(const std::vector<Vec3>& values)
{
    list(values, [&](const Vec3& value) { vector(value); });
}

Vec3 BinaryReader::vector()
{
    Vec3 value;
    for (double& c : value) c = number<double>();
    return value;
}

std::vector<Vec3> BinaryReader::vectors()
{
    return list<Vec3>(3 * sizeof(double), [&] { return vector(); });
}

std::string_view BinaryReader::take(std::uint64_t size)
{
    if (size > left_.size()) fail("is truncated or damaged");
    const std::string_view bytes = left_.substr(0, size);
    left_.remove_prefix(size);
    return bytes;
}

void BinaryReader::fail(std::string_view what) const
{
    throw InputError(fmt::format("{}: {}", printable(path_), what));
}

std::string seal(const FileKind& kind, const std::string& body)
{
    BinaryWriter file;
    file.text(kind.version);
    file.text(body);
    file.number(checksum(body));
    return std::string(kind.magic) + file.bytes();
}

void write_sealed(const std::string& path, const FileKind& kind, const std::string& body)
{
    write_atomically(path, seal(kind, body));
}

SealedFile read_sealed(const std::string& path, const FileKind& kind)
{
    std::ifstream in(path, std::ios::binary);
    if (!in || !std::filesystem::is_regular_file(path))
        throw InputError(fmt::format("{}: {}", printable(path), kind.missing));
    return unseal(std::string(std::istreambuf_iterator<char>(in), {}), path, kind);
}

SealedFile unseal(std::string_view bytes, const std::string& path, const FileKind& kind)
{
    if (bytes.empty()) throw InputError(fmt::format("{}: is empty: it {}", printable(path), kind.other));
    if (!bytes.starts_with(kind.magic)) throw InputError(fmt::format("{}: {}", printable(path), kind.other));
    BinaryReader file(bytes.substr(kind.magic.size()), path);
    std::string version = file.text();
    if (version != kind.version && (kind.earlier_version.empty() || version != kind.earlier_version))
        file.fail(fmt::format("was written by version {}; this is version {}", printable(version, 40),
                              kind.version));
    std::string body = file.text();
    if (file.number<std::uint32_t>() != checksum(body)) file.fail("is damaged: its checksum differs");
    if (!file.is_at_end()) file.fail("is damaged: it is longer than its counts say");
    return {std::move(version), std::move(body)};
}

}  // namespace arris
