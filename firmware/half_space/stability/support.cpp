#include "firmware/half_space/stability/support.h"

#include <fmt/format.h>

#include <cmath>

#include "firmware/half_space/host/host_program.h"
#include "firmware/half_space/host/hulls_program.h"

namespace dendro::half_space {
namespace {

constexpr const char* kProgram = "firmware/half_space/rds3000/half_space.gia";
constexpr const char* kHullsProgram = "firmware/half_space/rds3000/hulls.gia";
constexpr unsigned kLoresPixel = 2;  // bus function code

Words read_words(const MachineView& machine, int width, int height) {
  Words words;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      words.push_back(machine.peek(static_cast<std::uint32_t>(x) << 1 | static_cast<std::uint32_t>(y) << 11,
                                   kLoresPixel));
  return words;
}

}  // namespace

Words draw_all(const stability::Rig& rig, const std::vector<Prepared>& parts) {
  const lib::ProgramImage image = rig.program(kProgram);
  const PlaneProgram& first = parts.front().program;
  Words words;
  rig.run(
      [&](HostPort& host) {
        for (const Prepared& part : parts) run(host, part, image);
      },
      [&](const MachineView& machine) { words = read_words(machine, first.width, first.height); });
  return words;
}

Words draw_hulls(const stability::Rig& rig, const PreparedHulls& prepared) {
  const lib::ProgramImage image = rig.program(kHullsProgram);
  Words words;
  rig.run([&](HostPort& host) { run(host, prepared, image); },
          [&](const MachineView& machine) { words = read_words(machine, prepared.width, prepared.height); });
  return words;
}

Words draw(const stability::Rig& rig, const Prepared& prepared) { return draw_all(rig, {prepared}); }

Prepared from_screen(std::vector<ScreenPlane> planes, int width, int height, SteepPolicy steep,
                     int maxdepth) {
  Prepared prepared;
  PlaneProgram& program = prepared.program;
  program.width = width, program.height = height;
  program.box = {0, 0, width - 1, height - 1};
  program.maxdepth = maxdepth;
  program.steep = steep;
  program.shades = {Rgb{0, 0, 0}};
  int face = 0;
  for (ScreenPlane& plane : planes) {
    plane.kind = plane.c > 0 ? PlaneKind::kBack : plane.c < 0 ? PlaneKind::kFront : PlaneKind::kEdgeOn;
    plane.face = plane.kind == PlaneKind::kFront ? ++face : 0;
    if (plane.face != 0) program.shades.push_back(Rgb{255, 255, 255});
    const PlaneRecord record = make_record(plane, program.box, steep, maxdepth / 2.0);
    (record.kind == PlaneKind::kBack    ? program.back
     : record.kind == PlaneKind::kFront ? program.front
                                        : program.edge_on)
        .push_back(record);
  }
  prepared.screen = std::move(planes);
  return prepared;
}

scene::Scene looking_at(scene::Object object, int side, double height) {
  scene::Scene scene;
  scene.name = scene.file = "stability";
  scene.algorithm = "half_space";
  scene.image.width = scene.image.height = side;
  scene.camera.height = height;
  scene.camera.position = {0, 0, 5};
  scene.objects = {std::move(object)};
  scene.options = scene::Options("half_space", {"stability", 0});
  return with(std::move(scene), "starting_box", {std::string("full"), {"stability", 0}});
}

scene::Object random_solid(std::mt19937_64& random, const std::string& name) {
  std::uniform_real_distribution<double> degrees(0, 360);
  scene::Object object;
  object.solid = name;
  for (double& angle : object.rotate) angle = degrees(random);
  return object;
}

scene::Object random_hull(std::mt19937_64& random, int cuts) {
  std::normal_distribution<double> gauss;
  std::uniform_real_distribution<double> offset(0.5, 1.2);
  scene::Object object;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      scene::PlaneEntry plane;
      plane.normal = {0, 0, 0};
      plane.normal[static_cast<std::size_t>(axis)] = sign;
      plane.offset = offset(random);
      object.planes.push_back(plane);
    }
  for (int i = 0; i < cuts; ++i) {
    scene::PlaneEntry plane;
    plane.normal = {gauss(random), gauss(random), i % 3 == 0 ? gauss(random) / 200 : gauss(random)};
    plane.offset = offset(random) * std::hypot(plane.normal[0], plane.normal[1], plane.normal[2]);
    object.planes.push_back(plane);
  }
  return object;
}

scene::Scene with(scene::Scene scene, const std::string& key, const scene::OptionValue& value) {
  scene.options.set(key, value);
  return scene;
}

void compare_words(const Words& got, const Words& wanted, int width, const std::string& scene, Tally& tally) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    ++tally.pixels;
    if (got[i] == wanted[i]) continue;
    const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
    tally.fault(fmt::format("{}: pixel ({}, {}) is 0x{:06x}, not 0x{:06x}: face {} at {} instead of {} at {}",
                            scene, x, y, got[i], wanted[i], face_of(got[i]), depth_of(got[i]),
                            face_of(wanted[i]), depth_of(wanted[i])));
  }
}

void compare_enclosed(const Words& got, Enclosure& enclosure, int width, const std::string& scene,
                      Tally& tally) {
  for (std::size_t i = 0; i < got.size(); ++i) {
    ++tally.pixels;
    const int x = static_cast<int>(i) % width, y = static_cast<int>(i) / width;
    const std::string objection = enclosure.objection(x, y, got[i]);
    if (!objection.empty()) tally.fault(scene + ": " + objection);
  }
}

}  // namespace dendro::half_space
