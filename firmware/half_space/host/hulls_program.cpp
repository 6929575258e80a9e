#include "firmware/half_space/host/hulls_program.h"

#include <fmt/format.h>

#include "firmware/half_space/host/host_program.h"
#include "firmware/half_space/host/hulls_layout.h"
#include "sim/base/error.h"

namespace dendro::half_space {
namespace {

std::vector<std::uint32_t> box_words(const Box& box) {
  return {static_cast<std::uint32_t>(box.x0), static_cast<std::uint32_t>(box.y0),
          static_cast<std::uint32_t>(box.x1), static_cast<std::uint32_t>(box.y1)};
}

std::vector<std::uint32_t> params_of(const PlaneProgram& program, bool clear) {
  std::vector<std::uint32_t> params(kHullParamsWords, 0);
  params[kHullMaxDepth] = static_cast<std::uint32_t>(program.maxdepth);
  params[kHullBoxing] = program.boxing ? 1 : 0;
  params[kHullBackCount] = static_cast<std::uint32_t>(program.back.size());
  params[kHullEdgeOnCount] = static_cast<std::uint32_t>(program.edge_on.size());
  params[kHullFrontCount] = static_cast<std::uint32_t>(program.front.size());
  params[kHullClear] = clear ? 1 : 0;
  return params;
}

class HullsRun {
 public:
  HullsRun(HostPort& host, const PreparedHulls& prepared, const lib::ProgramImage& image)
      : host_(host), driver_(host), prepared_(prepared), image_(image) {}

  void load() {
    host_.phase("load_program");
    driver_.load_program(image_);
    if (prepared_.growth.flops > 0) {
      host_.phase("grow");
      host_.compute(prepared_.growth);
    }
    host_.phase("set_up");
    Work work;
    work.flops = prepared_.setup_flops;
    host_.compute(work);
  }

  void show(bool repeat_field) {
    host_.phase("load_tables");
    driver_.write_look_up_table(look_up_table(prepared_.shades));
    driver_.show_byte(kNearestLow);
    driver_.set_viewport(prepared_.width, prepared_.height, repeat_field);
  }

  void clear() {
    PlaneProgram everything;
    everything.maxdepth = prepared_.maxdepth;
    everything.box = {0, 0, prepared_.width - 1, prepared_.height - 1};
    send(everything, true);
  }

  void draw(const Hull& hull) { send(hull.program, false); }

 private:
  void send(const PlaneProgram& program, bool clear) {
    host_.phase("load_planes");
    driver_.write_scratch(image_.scratch.at("box").address, box_words(program.box));
    driver_.write_scratch(image_.scratch.at("params").address, params_of(program, clear));
    driver_.write_scratch(image_.scratch.at("records").address, program.record_words());
    driver_.start(image_.entry);
    host_.phase("finish");
    driver_.wait();
  }

  HostPort& host_;
  lib::RdsDriver driver_;
  const PreparedHulls& prepared_;
  const lib::ProgramImage& image_;
};

}  // namespace

void check_fits(const PreparedHulls& prepared, const lib::ProgramImage& image, std::uint32_t scratch_words,
                const scene::Where& where) {
  for (const auto& [name, size] :
       {std::pair("box", kBoxWords), {"params", int{kHullParamsWords}}, {"records", 0}}) {
    const auto area = image.scratch.find(name);
    if (area == image.scratch.end() || area->second.size < static_cast<std::uint32_t>(size))
      throw UserError(image.name + fmt::format(": the scratch area \"{}\" is missing or too small", name));
  }
  const std::uint32_t first = image.scratch.at("records").address;
  const std::size_t room = scratch_words > first ? scratch_words - first : 0;
  for (const Hull& hull : prepared.hulls) {
    if (hull.program.steep == SteepPolicy::kSaturate)
      throw UserError(where.file, where.line, "half_space.steep",
                      "this microprogram has no saturating adder; must be wide or wrap");
    const std::size_t wanted = hull.program.record_words().size();
    if (wanted > room)
      throw UserError(where.file, where.line, "object",
                      fmt::format("{} planes, {} of them wide, take {} scratchpad words; {} are free",
                                  hull.screen.size(), hull.program.wide_records(), wanted, room));
  }
}

void run(HostPort& host, const PreparedHulls& prepared, const lib::ProgramImage& image, bool repeat_field) {
  HullsRun run(host, prepared, image);
  run.load();
  run.show(repeat_field);
  run.clear();
  for (const Hull& hull : prepared.hulls)
    if (hull.visible) run.draw(hull);
}

}  // namespace dendro::half_space
