#include "firmware/half_space/host/host_program.h"

#include <fmt/format.h>

#include <algorithm>

#include "sim/base/check.h"
#include "sim/base/error.h"

namespace dendro::half_space {
namespace {

std::uint32_t widen(std::uint8_t level) { return static_cast<std::uint32_t>(level) << 2 | level >> 6; }

std::vector<std::uint32_t> params_of(const PlaneProgram& program, std::uint32_t size) {
  std::vector<std::uint32_t> params(kParamsWords, 0);
  params[kMaxDepth] = static_cast<std::uint32_t>(program.maxdepth);
  params[kBoxing] = program.boxing ? 1 : 0;
  params[kBackCount] = static_cast<std::uint32_t>(program.back.size());
  params[kEdgeOnCount] = static_cast<std::uint32_t>(program.edge_on.size());
  params[kFrontCount] = static_cast<std::uint32_t>(program.front.size());
  params[kSaturate] = program.steep == SteepPolicy::kSaturate ? 1 : 0;
  params.resize(std::min<std::uint32_t>(size, kParamsWords));
  return params;
}

}  // namespace

void check_areas(const ProgramImage& image,
                 const std::vector<std::pair<std::string, std::uint32_t>>& areas) {
  for (const auto& [name, size] : areas) {
    const auto area = image.scratch.find(name);
    if (area == image.scratch.end() || area->second.size < size)
      throw UserError(image.name + fmt::format(": the scratch area \"{}\" is missing or too small", name));
  }
}

void check_records(const PlaneProgram& program, const ProgramImage& image, std::uint32_t scratch_words,
                   const scene::Where& where) {
  const std::uint32_t first = image.scratch.at("records").address;
  const std::size_t wanted = program.record_words().size();
  const std::size_t room = scratch_words > first ? scratch_words - first : 0;
  if (wanted > room)
    throw UserError(where.file, where.line, "object",
                    fmt::format("{} planes, {} of them wide, take {} scratchpad words; {} are free",
                                program.back.size() + program.edge_on.size() + program.front.size(),
                                program.wide_records(), wanted, room));
}

void refuse_saturation(const scene::Where& where) {
  throw UserError(where.file, where.line, "half_space.steep",
                  "this microprogram has no saturating adder; must be wide or wrap");
}

std::vector<std::uint32_t> box_words(const Box& box) {
  return {static_cast<std::uint32_t>(box.x0), static_cast<std::uint32_t>(box.y0),
          static_cast<std::uint32_t>(box.x1), static_cast<std::uint32_t>(box.y1)};
}

void check_fits(const Prepared& prepared, const ProgramImage& image, std::uint32_t scratch_words,
                const scene::Where& where) {
  check_areas(image, {{"box", kBoxWords}, {"params", kSaturate}, {"records", 0}});
  if (prepared.program.steep == SteepPolicy::kSaturate && image.scratch.at("params").size < kParamsWords)
    refuse_saturation(where);
  check_records(prepared.program, image, scratch_words, where);
}

std::vector<std::uint32_t> look_up_table(const std::vector<Rgb>& shades) {
  std::vector<std::uint32_t> table(1024);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const std::size_t face = i % 256;
    const Rgb& rgb = shades[face < shades.size() ? face : 0];
    table[i] = widen(rgb[0]) | widen(rgb[1]) << 10 | widen(rgb[2]) << 20;
  }
  return table;
}

void compute_set_up(HostPort& host, const Work& growth, std::uint64_t setup_flops, std::string_view set_up) {
  if (growth.flops > 0) {
    host.phase("grow");
    host.compute(growth);
  }
  host.phase(set_up);
  Work work;
  work.flops = setup_flops;
  host.compute(work);
}

void run(HostPort& host, const Prepared& prepared, const ProgramImage& image, bool repeat_field) {
  RdsDriver driver(host);
  const PlaneProgram& program = prepared.program;

  host.phase("load_program");
  driver.load_program(image);

  compute_set_up(host, prepared.growth, prepared.setup_flops, "load_planes");
  driver.write_scratch(image.scratch.at("box").address, box_words(program.box));
  const ScratchArea& params = image.scratch.at("params");
  driver.write_scratch(params.address, params_of(program, params.size));
  driver.write_scratch(image.scratch.at("records").address, program.record_words());

  host.phase("load_tables");
  driver.write_look_up_table(look_up_table(program.shades));
  driver.show_byte(kFaceLow);
  driver.set_viewport(program.width, program.height, repeat_field);

  driver.start(image.entry);
  host.phase("finish");
  driver.wait();
}

}  // namespace dendro::half_space
