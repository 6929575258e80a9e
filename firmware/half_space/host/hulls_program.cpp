#include "firmware/half_space/host/hulls_program.h"

#include "firmware/half_space/host/host_program.h"

namespace dendro::half_space {
namespace {

std::vector<std::uint32_t> params_of(const PlaneProgram& program, HullAction action) {
  std::vector<std::uint32_t> params(kHullParamsWords, 0);
  params[kHullMaxDepth] = static_cast<std::uint32_t>(program.maxdepth);
  params[kHullBoxing] = program.boxing ? 1 : 0;
  params[kHullBackCount] = static_cast<std::uint32_t>(program.back.size());
  params[kHullEdgeOnCount] = static_cast<std::uint32_t>(program.edge_on.size());
  params[kHullFrontCount] = static_cast<std::uint32_t>(program.front.size());
  params[kHullAction] = static_cast<std::uint32_t>(action);
  return params;
}

PlaneProgram no_planes(const Box& box, int maxdepth) {
  PlaneProgram program;
  program.maxdepth = maxdepth;
  program.box = box;
  return program;
}

}  // namespace

void HullsDriver::clear(int width, int height, int maxdepth) {
  send(no_planes({0, 0, width - 1, height - 1}, maxdepth), HullAction::kClear, {});
}

void HullsDriver::draw(const PlaneProgram& program, HullAction action) {
  send(program, action, program.record_words());
}

void HullsDriver::merge(const PlaneProgram& program, const Box& box) {
  send(no_planes(box, program.maxdepth), HullAction::kMerge, {});
}

void HullsDriver::paint(const Trapezium& trapezium, int maxdepth) {
  send(no_planes(trapezium.box, maxdepth), HullAction::kPainter, trapezium.words());
}

std::optional<Box> HullsDriver::box_left() {
  const auto word = [&](const char* area) {
    return static_cast<std::int32_t>(driver_.read_scratch(image_.scratch.at(area).address, 1).front());
  };
  if (word("empty") != 0) return std::nullopt;
  // The microprogram counts in half pixels, as the bus does.
  return Box{word("xs") / 2, word("ys") / 2, word("xe") / 2, word("ye") / 2};
}

void HullsDriver::send(const PlaneProgram& program, HullAction action,
                       const std::vector<std::uint32_t>& records) {
  host_.phase("load_planes");
  driver_.write_scratch(image_.scratch.at("box").address, box_words(program.box));
  driver_.write_scratch(image_.scratch.at("params").address, params_of(program, action));
  driver_.write_scratch(image_.scratch.at("records").address, records);
  driver_.start(entry_);
  host_.phase("finish");
  driver_.wait();
}

void check_fits(const PreparedHulls& prepared, const lib::ProgramImage& image, std::uint32_t scratch_words,
                const scene::Where& where) {
  check_areas(image, {{"box", kBoxWords}, {"params", kHullParamsWords}, {"records", 4}});
  const auto check = [&](const Hull& hull) {
    if (hull.program.steep == SteepPolicy::kSaturate) refuse_saturation(where);
    check_records(hull.program, image, scratch_words, where);
  };
  for (const Hull& hull : prepared.hulls) check(hull);
  for (const Trunk& trunk : prepared.trunks) check(trunk.hull);
}

void run(HostPort& host, const PreparedHulls& prepared, const lib::ProgramImage& image, bool repeat_field) {
  lib::RdsDriver driver(host);
  host.phase("load_program");
  driver.load_program(image);
  compute_set_up(host, prepared.growth, prepared.setup_flops, "set_up");
  host.phase("load_tables");
  driver.write_look_up_table(look_up_table(prepared.shades));
  driver.show_byte(kNearestLow);
  driver.set_viewport(prepared.width, prepared.height, repeat_field);

  HullsDriver hulls(host, driver, image);
  hulls.clear(prepared.width, prepared.height, prepared.maxdepth);
  for (const Hull& hull : prepared.hulls)
    if (hull.visible) hulls.draw(hull.program, HullAction::kPassesAndMerge);
}

}  // namespace dendro::half_space
