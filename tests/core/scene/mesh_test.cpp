#include "sim/scene/mesh.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <iterator>
#include <string>

#include "sim/base/error.h"

namespace dendro::scene {
namespace {

namespace fs = std::filesystem;

const std::string kMeshes = MESHES;

const char* const kTetrahedronObj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// A folder of its own for each test.
class MeshFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) /
              (std::string("dendro_mesh_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& bytes) const {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  /// The message of the UserError that loading throws; it must name the file on one line.
  static std::string refusal(const std::string& file) {
    try {
      load_mesh(file, {"scene.toml", 7}, "object.mesh");
    } catch (const UserError& error) {
      const std::string text = error.what();
      EXPECT_NE(text.find(fs::path(file).filename().string()), std::string::npos) << text;
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      return text;
    }
    ADD_FAILURE() << file << " was read";
    return {};
  }

  fs::path folder_;
};

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::string gzip(const std::string& bytes) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(deflateBound(&stream, bytes.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

double area_of(const Mesh& mesh) {
  double area = 0;
  for (const auto& t : mesh.triangles)
    area += 0.5 * glm::length(glm::cross(mesh.vertices[t[1]] - mesh.vertices[t[0]],
                                         mesh.vertices[t[2]] - mesh.vertices[t[0]]));
  return area;
}

TEST_F(MeshFile, ShippedMeshesHaveTheCountsOfTheirReadme) {
  EXPECT_EQ(load_mesh(kMeshes + "/staunton_bishop.stl").triangles.size(), 11898u);
  EXPECT_EQ(load_mesh(kMeshes + "/tree_pine_orange_large.obj").triangles.size(), 318u);
  EXPECT_EQ(load_mesh(kMeshes + "/arbaro_quaking_aspen.obj.gz").triangles.size(), 152203u);
}

TEST_F(MeshFile, GroupsOfAnObjAreItsHierarchy) {
  const Mesh mesh = load_mesh(kMeshes + "/arbaro_quaking_aspen.obj.gz");
  std::vector<std::string> names;
  std::size_t next = 0;
  for (const MeshGroup& group : mesh.groups) {
    EXPECT_EQ(group.first, next);
    next += group.count;
    names.push_back(group.name);
  }
  EXPECT_EQ(next, mesh.triangles.size());
  EXPECT_EQ(names, (std::vector<std::string>{"trunk", "stems_1", "stems_2", "leaves"}));
}

TEST_F(MeshFile, AGltfWithItsBinIsTheSameModelAsTheObj) {
  const Mesh obj = load_mesh(kMeshes + "/tree_pine_orange_large.obj");
  const Mesh gltf = load_mesh(kMeshes + "/tree_pine_orange_large.gltf");
  EXPECT_EQ(gltf.triangles.size(), obj.triangles.size());
  EXPECT_NEAR(area_of(gltf), area_of(obj), 1e-4 * area_of(obj));
  ASSERT_EQ(gltf.files.size(), 2u) << "the .bin is an input too";
  EXPECT_NE(gltf.files[0].find(".bin"), std::string::npos);
}

TEST_F(MeshFile, AGzippedFileIsReadLikeThePlainOne) {
  const Mesh plain = load_mesh(kMeshes + "/staunton_bishop.stl");
  const Mesh zipped = load_mesh(write("bishop.STL.gz", gzip(bytes_of(kMeshes + "/staunton_bishop.stl"))));
  EXPECT_EQ(zipped.triangles, plain.triangles);
  EXPECT_EQ(zipped.vertices, plain.vertices);
}

TEST_F(MeshFile, QuadsAndNegativeIndicesOfAnObjBecomeTriangles) {
  const Mesh mesh =
      load_mesh(write("quad.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nusemtl none\nf -4 -3 -2 -1\n"));
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_DOUBLE_EQ(area_of(mesh), 2.0);
}

std::string ply(const std::string& format, const std::function<std::string(float)>& real,
                const std::function<std::string(int)>& index) {
  std::string text = "ply\nformat " + format +
                     " 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                     "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n";
  const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  const bool ascii = format == "ascii";
  for (const auto& corner : corners) {
    for (const float v : corner) text += real(v);
    if (ascii) text += "\n";
  }
  for (const auto& face : faces) {
    text += ascii ? "3 " : std::string(1, 3);
    for (const int i : face) text += index(i);
    if (ascii) text += "\n";
  }
  return text;
}

template <typename T>
std::string raw(T value, bool reversed) {
  std::string bytes(sizeof value, '\0');
  std::memcpy(bytes.data(), &value, sizeof value);
  return reversed ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
}

TEST_F(MeshFile, PlyIsReadAsTextAndInBothByteOrders) {
  const double area = 1.5 + 0.5 * std::sqrt(3.0);
  const std::string ascii = ply(
      "ascii", [](float v) { return std::to_string(v) + " "; },
      [](int i) { return std::to_string(i) + " "; });
  EXPECT_NEAR(area_of(load_mesh(write("a.ply", ascii))), area, 1e-6);
  for (const bool big : {false, true}) {
    const std::string binary = ply(
        big ? "binary_big_endian" : "binary_little_endian", [&](float v) { return raw(v, big); },
        [&](int i) { return raw(i, big); });
    EXPECT_NEAR(area_of(load_mesh(write(big ? "b.ply" : "l.ply", binary))), area, 1e-6)
        << "big endian " << big;
  }
}

TEST_F(MeshFile, ATruncatedGzIsRefused) {
  const std::string whole = gzip(kTetrahedronObj);
  for (const std::size_t cut : {std::size_t{1}, std::size_t{8}, whole.size() / 2})
    EXPECT_NE(refusal(write("t.obj.gz", whole.substr(0, whole.size() - cut))).find("truncated"),
              std::string::npos);
}

TEST_F(MeshFile, ADamagedGzIsRefused) {
  std::string bytes = gzip(kTetrahedronObj);
  bytes[bytes.size() - 6] ^= 0x55;  // its checksum
  EXPECT_NE(refusal(write("t.obj.gz", bytes)).find("damaged"), std::string::npos);
}

TEST_F(MeshFile, AFileThatIsNoGzAlthoughItsNameSaysSoIsRefused) {
  EXPECT_NE(refusal(write("t.obj.gz", kTetrahedronObj)).find("not a .gz"), std::string::npos);
}

TEST_F(MeshFile, WhatIsNotAReadableFileIsRefused) {
  EXPECT_NE(refusal(path("none.obj")).find("does not exist"), std::string::npos);
  fs::create_directories(folder_ / "folder.obj");
  EXPECT_NE(refusal(path("folder.obj")).find("regular file"), std::string::npos);
  refusal(write("empty.obj", ""));
  refusal(write("short.stl", "solid"));
  refusal(write("noise.glb", std::string(200, '\x7f')));
}

TEST_F(MeshFile, AnUnknownEndingIsBlamedOnTheSceneFile) {
  const std::string text = refusal(write("t.dae", "x"));
  EXPECT_EQ(text.find("scene.toml:7: object.mesh: "), 0u) << text;
}

TEST_F(MeshFile, CoordinatesThatAreNotFiniteAreRefused) {
  for (const char* bad : {"nan", "inf", "-inf", "1e60"}) {
    const std::string text = "v 0 0 0\nv 1 0 0\nv 0 " + std::string(bad) + " 0\nf 1 2 3\n";
    EXPECT_NE(refusal(write("bad.obj", text)).find("not finite"), std::string::npos) << bad;
  }
}

TEST_F(MeshFile, AMeshWithoutFacesIsRefused) {
  refusal(write("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"));
  refusal(write("lines.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nl 1 2 3\n"));
}

TEST_F(MeshFile, AMeshWhoseFacesAllHaveZeroAreaIsRefused) {
  const std::string text = refusal(write("thin.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 2\n"));
  EXPECT_NE(text.find("zero area"), std::string::npos) << text;
}

TEST_F(MeshFile, AGltfWhoseBinIsMissingIsRefused) {
  refusal(write("tree_pine_orange_large.gltf", bytes_of(kMeshes + "/tree_pine_orange_large.gltf")));
}

TEST_F(MeshFile, AHeaderThatPromisesMoreThanTheFileHoldsIsTruncation) {
  const std::string ply = write("g.ply",
                                "ply\nformat ascii 1.0\nelement vertex 99999999999\nproperty float x\n"
                                "property float y\nproperty float z\nelement face 1\n"
                                "property list uchar int vertex_indices\nend_header\n0 0 0\n");
  EXPECT_NE(refusal(ply).find("is truncated: its header promises 100000000000 elements"), std::string::npos)
      << refusal(ply);
  std::string stl(84 + 50, '\0');
  stl[80] = 2;
  EXPECT_NE(refusal(write("t.stl", stl)).find("is truncated: its header promises 2 triangles"), std::string::npos);
}

}  // namespace
}  // namespace dendro::scene
