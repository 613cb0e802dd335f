// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/geometry/mesh_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace arris::mesh_files {
namespace {

template <class Number>
void append(std::string& bytes, Number number, bool is_big_endian = false)
{
    std::string raw(sizeof number, '\0');
    std::memcpy(raw.data(), &number, sizeof number);
    if (is_big_endian) std::reverse(raw.begin(), raw.end());
    bytes += raw;
}

void append_floats(std::string& bytes, const Vec3& p, bool is_big_endian = false)
{
    for (const double x : p) append(bytes, static_cast<float>(x), is_big_endian);
}

PolygonMesh to_polygons(const ObstacleMesh& mesh)
{
    PolygonMesh polygons = {mesh.points, {}};
    for (const Face& face : mesh.faces) polygons.faces.emplace_back(face.begin(), face.end());
    return polygons;
}

/// The corners of a polygon, each after a blank; the first point of the file has the number `first`.
std::string indices(const std::vector<int>& face, int first)
{
    std::string text;
    for (const int p : face) text += fmt::format(" {}", p + first);
    return text;
}

std::string numbers(const std::vector<Vec3>& points)
{
    std::string text;
    for (const Vec3& p : points) text += fmt::format("{} {} {} ", p.x(), p.y(), p.z());
    return text;
}

std::string ply_header(std::size_t points, std::size_t faces, const std::string& format)
{
    return fmt::format(
        "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "element face {}\nproperty list uchar int vertex_indices\nend_header\n",
        format, points, faces);
}

std::string chunk_3ds(std::uint16_t id, const std::string& content)
{
    std::string bytes;
    append(bytes, id);
    append(bytes, static_cast<std::uint32_t>(content.size() + 6));
    return bytes + content;
}

std::uint32_t crc32(const std::string& bytes)
{
    std::uint32_t crc = 0xffffffffu;
    for (const char c : bytes) {
        crc ^= static_cast<std::uint8_t>(c);
        for (int k = 0; k < 8; ++k) crc = crc >> 1 ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
    }
    return ~crc;
}

}  // namespace

std::string zip(const std::vector<std::pair<std::string, std::string>>& files)
{
    std::string bytes, directory;
    for (const auto& [name, content] : files) {
        std::string about;                 // fields that both headers share
        append(about, std::uint16_t{20});  // version
        append(about, std::uint64_t{0});   // flags, method 0 (stored), time and date
        append(about, crc32(content));
        for (int k = 0; k < 2; ++k) append(about, static_cast<std::uint32_t>(content.size()));
        append(about, static_cast<std::uint16_t>(name.size()));
        append(about, std::uint16_t{0});
        directory += "PK\x01\x02";
        append(directory, std::uint16_t{20});
        directory += about;
        for (int k = 0; k < 3; ++k) append(directory, std::uint16_t{0});
        append(directory, std::uint32_t{0});
        append(directory, static_cast<std::uint32_t>(bytes.size()));
        directory += name;
        bytes += "PK\x03\x04" + about + name + content;
    }
    std::string end = "PK\x05\x06";
    append(end, std::uint32_t{0});
    for (int k = 0; k < 2; ++k) append(end, static_cast<std::uint16_t>(files.size()));
    append(end, static_cast<std::uint32_t>(directory.size()));
    append(end, static_cast<std::uint32_t>(bytes.size()));
    append(end, std::uint16_t{0});
    return bytes + directory + end;
}

std::string obj(const PolygonMesh& mesh)
{
    std::string text;
    for (const Vec3& p : mesh.points) text += fmt::format("v {} {} {}\n", p.x(), p.y(), p.z());
    for (const std::vector<int>& face : mesh.faces) text += "f" + indices(face, 1) + "\n";
    return text;
}

std::string obj(const ObstacleMesh& mesh)
{
    std::string text = obj(to_polygons(mesh));
    for (const auto& [a, b] : mesh.segments) text += fmt::format("l {} {}\n", a + 1, b + 1);
    for (const int p : mesh.lone_points) text += fmt::format("p {}\n", p + 1);
    return text;
}

std::string ascii_stl(const ObstacleMesh& mesh)
{
    std::string text = "solid box\n";
    for (const Face& face : mesh.faces) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const int p : face)
            text +=
                fmt::format("vertex {} {} {}\n", mesh.points[p].x(), mesh.points[p].y(), mesh.points[p].z());
        text += "endloop\nendfacet\n";
    }
    return text + "endsolid box\n";
}

std::string binary_stl(const ObstacleMesh& mesh)
{
    std::string bytes(80, ' ');
    append(bytes, static_cast<std::uint32_t>(mesh.faces.size()));
    for (const Face& face : mesh.faces) {
        append_floats(bytes, Vec3::Zero());
        for (const int p : face) append_floats(bytes, mesh.points[p]);
        append(bytes, std::uint16_t{0});
    }
    return bytes;
}

std::string ascii_ply(const PolygonMesh& mesh)
{
    std::string text = ply_header(mesh.points.size(), mesh.faces.size(), "ascii");
    for (const Vec3& p : mesh.points) text += fmt::format("{} {} {}\n", p.x(), p.y(), p.z());
    for (const std::vector<int>& face : mesh.faces)
        text += fmt::format("{}{}\n", face.size(), indices(face, 0));
    return text;
}

std::string ascii_ply(const ObstacleMesh& mesh)
{
    return ascii_ply(to_polygons(mesh));
}

std::string binary_ply(const ObstacleMesh& mesh, bool is_big_endian)
{
    std::string bytes = ply_header(mesh.points.size(), mesh.faces.size(),
                                   is_big_endian ? "binary_big_endian" : "binary_little_endian");
    for (const Vec3& p : mesh.points) append_floats(bytes, p, is_big_endian);
    for (const Face& face : mesh.faces) {
        bytes += '\3';
        for (const int p : face) append(bytes, p, is_big_endian);
    }
    return bytes;
}

std::string gltf_buffer(const ObstacleMesh& mesh)
{
    std::string bytes;
    for (const Vec3& p : mesh.points) append_floats(bytes, p);
    for (const Face& face : mesh.faces)
        for (const int p : face) append(bytes, static_cast<std::uint16_t>(p));
    return bytes;
}

std::string gltf_json(const ObstacleMesh& mesh, const std::string& uri, const std::string& node)
{
    Vec3 low = mesh.points.front();
    Vec3 high = low;
    for (const Vec3& p : mesh.points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const std::size_t places = 12 * mesh.points.size();
    const std::size_t indices = 6 * mesh.faces.size();
    return fmt::format(
        R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0{}}}],)"
        R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0}},"indices":1,"mode":4}}]}}],)"
        R"("accessors":[{{"bufferView":0,"componentType":5126,"count":{},"type":"VEC3",)"
        R"("min":[{},{},{}],"max":[{},{},{}]}},)"
        R"({{"bufferView":1,"componentType":5123,"count":{},"type":"SCALAR"}}],)"
        R"("bufferViews":[{{"buffer":0,"byteOffset":0,"byteLength":{}}},)"
        R"({{"buffer":0,"byteOffset":{},"byteLength":{}}}],"buffers":[{{"byteLength":{}{}}}]}})",
        node, mesh.points.size(), low.x(), low.y(), low.z(), high.x(), high.y(), high.z(),
        3 * mesh.faces.size(), places, places, indices, places + indices,
        uri.empty() ? "" : fmt::format(R"(,"uri":"{}")", uri));
}

std::string glb(const ObstacleMesh& mesh, const std::string& node)
{
    std::string json = gltf_json(mesh, "", node);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string buffer = gltf_buffer(mesh);
    buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
    std::string bytes = "glTF";
    append(bytes, std::uint32_t{2});
    append(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
    append(bytes, static_cast<std::uint32_t>(json.size()));
    bytes += "JSON" + json;
    append(bytes, static_cast<std::uint32_t>(buffer.size()));
    return bytes + std::string("BIN\0", 4) + buffer;
}

namespace {

/// `faces`: the element that holds them.
std::string dae(const std::vector<Vec3>& points, const std::string& faces, const std::string& asset,
                const std::string& matrix)
{
    return fmt::format(
        R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>{}</asset>
<library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count="{}">{}</float_array><technique_common>
<accessor source="#a" count="{}" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
{}
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node id="n">{}<instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>
)",
        asset, 3 * points.size(), numbers(points), points.size(), faces,
        matrix.empty() ? "" : "<matrix>" + matrix + "</matrix>");
}

}  // namespace

std::string dae(const PolygonMesh& mesh, const std::string& asset)
{
    std::string counts, corners;
    for (const std::vector<int>& face : mesh.faces) {
        counts += fmt::format("{} ", face.size());
        corners += indices(face, 0);
    }
    return dae(mesh.points,
               fmt::format(R"(<polylist count="{}"><input semantic="VERTEX" source="#v" offset="0"/>)"
                           R"(<vcount>{}</vcount><p>{}</p></polylist>)",
                           mesh.faces.size(), counts, corners),
               asset, "");
}

std::string dae(const ObstacleMesh& mesh, const std::string& asset, const std::string& matrix)
{
    std::string corners;
    for (const auto& [a, b, c] : mesh.faces) corners += fmt::format("{} {} {} ", a, b, c);
    return dae(mesh.points,
               fmt::format(R"(<triangles count="{}"><input semantic="VERTEX" source="#v" offset="0"/>)"
                           R"(<p>{}</p></triangles>)",
                           mesh.faces.size(), corners),
               asset, matrix);
}

std::string fbx(const PolygonMesh& mesh, int up_axis, double centimetres_per_unit)
{
    std::string places, corners;
    std::size_t count = 0;
    for (const Vec3& p : mesh.points) places += fmt::format("{},{},{},", p.x(), p.y(), p.z());
    for (const std::vector<int>& face : mesh.faces)
        for (std::size_t k = 0; k < face.size(); ++k, ++count)
            corners += fmt::format("{},", k + 1 < face.size() ? face[k] : -face[k] - 1);
    places.pop_back();
    corners.pop_back();
    return fmt::format(
        R"(; FBX 7.3.0 project file
FBXHeaderExtension:  {{
	FBXHeaderVersion: 1003
	FBXVersion: 7300
}}
GlobalSettings:  {{
	Version: 1000
	Properties70:  {{
		P: "UpAxis", "int", "Integer", "",{}
		P: "UpAxisSign", "int", "Integer", "",1
		P: "UnitScaleFactor", "double", "Number", "",{}
	}}
}}
Documents:  {{
	Count: 1
	Document: 1, "", "Scene" {{
		RootNode: 0
	}}
}}
Definitions:  {{
	Version: 100
	Count: 0
}}
Objects:  {{
	Geometry: 10, "Geometry::box", "Mesh" {{
		Vertices: *{} {{
			a: {}
		}}
		PolygonVertexIndex: *{} {{
			a: {}
		}}
		GeometryVersion: 124
	}}
	Model: 20, "Model::box", "Mesh" {{
		Version: 232
		Properties70:  {{
		}}
	}}
}}
Connections:  {{
	C: "OO",20,0
	C: "OO",10,20
}}
)",
        up_axis, centimetres_per_unit, 3 * mesh.points.size(), places, count, corners);
}

std::string fbx(const ObstacleMesh& mesh, int up_axis, double centimetres_per_unit)
{
    return fbx(to_polygons(mesh), up_axis, centimetres_per_unit);
}

std::string three_ds(const ObstacleMesh& mesh)
{
    std::string points;
    append(points, static_cast<std::uint16_t>(mesh.points.size()));
    for (const Vec3& p : mesh.points) append_floats(points, p);
    std::string faces;
    append(faces, static_cast<std::uint16_t>(mesh.faces.size()));
    for (const Face& face : mesh.faces) {
        for (const int p : face) append(faces, static_cast<std::uint16_t>(p));
        append(faces, std::uint16_t{0});
    }
    const std::string triangles = chunk_3ds(0x4100, chunk_3ds(0x4110, points) + chunk_3ds(0x4120, faces));
    return chunk_3ds(0x4d4d, chunk_3ds(0x3d3d, chunk_3ds(0x4000, std::string("box\0", 4) + triangles)));
}

std::string three_mf_model(const ObstacleMesh& mesh, const std::string& attributes)
{
    std::string model = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model" + attributes +
                        " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<resources>"
                        "<object id=\"1\" type=\"model\"><mesh><vertices>\n";
    for (const Vec3& p : mesh.points)
        model += fmt::format("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", p.x(), p.y(), p.z());
    model += "</vertices><triangles>\n";
    for (const auto& [a, b, c] : mesh.faces)
        model += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", a, b, c);
    return model + "</triangles></mesh></object></resources><build><item objectid=\"1\"/></build></model>\n";
}

std::string three_mf_package(const std::string& model)
{
    return zip(
        {{"[Content_Types].xml",
          "<?xml version=\"1.0\"?><Types xmlns=\"http://schemas.openxmlformats.org/package/2006/"
          "content-types\"/>"},
         {"_rels/.rels",
          "<?xml version=\"1.0\"?><Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/"
          "relationships\"><Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
          "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"},
         {"3D/3dmodel.model", model}});
}

std::string three_mf(const ObstacleMesh& mesh, const std::string& attributes)
{
    return three_mf_package(three_mf_model(mesh, attributes));
}

}  // namespace arris::mesh_files
