#include "sim/study/algorithms.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "firmware/half_space/job.h"
#include "firmware/half_space/planes_job.h"
#include "firmware/tools/assembler.h"
#include "firmware/tools/ucode.h"
#include "sim/base/check.h"
#include "sim/base/embedded.h"
#include "sim/base/error.h"
#include "sim/base/sha256.h"
#include "sim/config/document.h"
#include "sim/study/equalisation.h"
#include "sim/study/igc_programs.h"
#include "sim/study/primitives.h"
#include "sim/study/zbuffer_views.h"

namespace dendro::study {
std::int64_t integer_of(const config::ParameterSet& parameters, const std::string& key) {
  const config::Parameter* p = parameters.find(key);
  if (p == nullptr || !std::holds_alternative<std::int64_t>(p->value))
    throw UserError("", 0, key, "this parameter of the machine is missing or no integer");
  return std::get<std::int64_t>(p->value);
}

std::optional<std::string> shipped_include(const std::string& path) {
  const std::string* text = base::embedded_file(path);
  return text == nullptr ? std::nullopt : std::optional(*text);
}

tools::IncludeReader include_beside(const std::string& source) {
  return [folder = std::filesystem::path(source).parent_path()](const std::string& path) {
    const std::filesystem::path beside = folder / path;
    if (!std::filesystem::is_regular_file(beside)) return shipped_include(path);
    return std::optional(config::read_text({false, beside.string()}, {}));
  };
}

namespace {

struct Source {
  const char* name;
  const char* machine;
  const char* path;
};

constexpr Source kHalfSpace = {"half_space", "rds3000", "firmware/half_space/rds3000/half_space.gia"};

constexpr Source kHulls = {"hulls", "rds3000", "firmware/half_space/rds3000/hulls.gia"};

constexpr Source kRoughen = {"roughen", "rds3000", "firmware/half_space/rds3000/roughen.gia"};
constexpr Source kTexture = {"texture", "rds3000", "firmware/half_space/rds3000/texture.gia"};
constexpr Source kColour = {"colour", "rds3000", "firmware/half_space/rds3000/colour.gia"};

const Source kSources[] = {kHalfSpace, kHulls, kRoughen, kTexture, kColour};
const char* const kPacks[] = {"none", "full"};

tools::Assembly assemble_source(const Source& source, tools::AssembleOptions options) {
  const std::string* text = base::embedded_file(source.path);
  DENDRO_CHECK(text != nullptr, "{}", source.path);
  options.include = shipped_include;
  return tools::assemble(*text, source.path, options);
}

std::string text_of(const config::ParameterSet& parameters, const std::string& key) {
  const config::Parameter* p = parameters.find(key);
  if (p == nullptr || !std::holds_alternative<std::string>(p->value))
    throw UserError("", 0, key, "this parameter of the machine is missing or no string");
  return std::get<std::string>(p->value);
}

bool assembles(const Source& source, const tools::AssembleOptions& options) {
  try {
    assemble_source(source, options);
    return true;
  } catch (const UserError&) {
    return false;
  }
}

/// A shipped program assembles for a machine as documented, so the parameter whose usual value would make it
/// assemble again is the one to blame.
[[noreturn]] void blame_parameter(const Source& source, const config::ParameterSet& parameters,
                                  const tools::AssembleOptions& options, const UserError& error) {
  const tools::AssembleOptions usual;
  tools::AssembleOptions scratch = options, multiply = options, control = options;
  scratch.scratch_words = usual.scratch_words;
  multiply.multiply_ticks = usual.multiply_ticks;
  control.control_words = usual.control_words;
  for (const auto& [key, changed] : {std::pair("processor.scratch_words", scratch),
                                     {"processor.multiply_ticks", multiply},
                                     {"processor.control_store_words", control}}) {
    if (!assembles(source, changed)) continue;
    const config::Where where = parameters.find(key)->where;
    throw UserError(
        where.file, where.line, key,
        std::string("the firmware ") + source.name + " cannot run on this machine: " + error.message());
  }
  throw;
}

tools::Ucode assemble_for(const Source& source, const config::ParameterSet& parameters) {
  tools::AssembleOptions options;
  options.pack = text_of(parameters, "microcode.pack");
  options.multiply_ticks = static_cast<int>(integer_of(parameters, "processor.multiply_ticks"));
  const std::int64_t page = 4096;
  options.scratch_words = static_cast<unsigned>(integer_of(parameters, "processor.scratch_words"));
  options.control_words =
      static_cast<unsigned>(std::min(page, integer_of(parameters, "processor.control_store_words")));
  options.fill_products = true;
  try {
    return assemble_source(source, options).ucode;
  } catch (const UserError& error) {
    blame_parameter(source, parameters, options, error);
  }
}

/// The program is assembled for the machine at hand: its latencies and sizes are parameters, and so is how
/// densely the compiler of its time packed.
half_space::ProgramImage program_for(const Source& source, const config::ParameterSet& parameters) {
  const tools::Ucode ucode = assemble_for(source, parameters);
  half_space::ProgramImage image;
  image.name = std::string(source.path) + " (pack " + ucode.pack + ")";
  image.sha256 = base::sha256(tools::write_ucode(ucode));
  image.words = ucode.words;
  image.entry = ucode.entry;
  image.symbols = ucode.symbols;
  for (const auto& [name, area] : ucode.scratch) image.scratch[name] = {area.address, area.size};
  image.initial_scratch = ucode.scratch_data;
  return image;
}

constexpr const char* kPixelPlanes = "pixel-planes";
constexpr const char* kPlanesSources[] = {"firmware/half_space/pixel_planes/half_space.igc",
                                          "firmware/half_space/pixel_planes/two_ports.igc"};

/// Only the programs of half_space.igc run with one port.
lib::IgcPrograms planes_programs(const half_space::ArraySite& site, const half_space::PixelLayout& layout) {
  tools::IgcOptions options;
  options.ports = site.ports, options.memory_bits = site.memory_bits;
  options.registers = layout.registers();
  if (layout.variant != half_space::StreamVariant::kScratch) options.registers.erase("scratch");
  if (layout.colouring != half_space::Colouring::kIndex) options.registers.erase("index");
  return igc_programs({kPlanesSources, kPlanesSources + site.ports}, options);
}

std::unique_ptr<Job> make_planes(const scene::Scene& scene, const config::ParameterSet& parameters) {
  const lib::ArraySite site = array_site(parameters);
  return half_space::make_planes_job(scene, planes_programs(site, half_space::choose_layout(scene, site)), site);
}

std::unique_ptr<Job> make_half_space(const scene::Scene& scene, const MachineType& type,
                                     const config::ParameterSet& parameters) {
  if (type.name == kPixelPlanes) return make_planes(scene, parameters);
  DENDRO_CHECK(type.name == kHalfSpace.machine, "{}", type.name);
  half_space::Site site;
  site.scratch_words = static_cast<std::uint32_t>(integer_of(parameters, "processor.scratch_words"));
  const config::Parameter* mode = parameters.find("video.display_mode");
  site.repeat_field = mode != nullptr && config::to_text(mode->value) == "1";
  site.control_store_words = static_cast<std::uint32_t>(integer_of(parameters, "processor.control_store_words"));
  site.pixel_bits = static_cast<unsigned>(integer_of(parameters, "frame_memory.bits_per_pixel"));
  if (half_space::is_complete_tree(scene)) {
    const auto program = [&](const std::string& name) {
      const Source* source = std::find_if(std::begin(kSources), std::end(kSources),
                                          [&](const Source& s) { return name == s.name; });
      DENDRO_CHECK(source != std::end(kSources), "{}", name);
      return program_for(*source, parameters);
    };
    return half_space::make_tree_job(scene, program, site);
  }
  if (half_space::needs_three_registers(scene))
    return half_space::make_hulls_job(scene, program_for(kHulls, parameters), site);
  return half_space::make_job(scene, program_for(kHalfSpace, parameters), site);
}

}  // namespace

const std::vector<Algorithm>& algorithms() {
  static const std::vector<Algorithm> list = {
      {"half_space",
       "trees as intersections of half-spaces, two depth registers a pixel (FG86)",
       {"rds3000", "pixel-planes"},
       "firmware/half_space",
       make_half_space,
       {"planes", "plane_source", "directions", "unbounded", "starting_box", "boxing", "depth_bits",
        "depth_margin", "depth_range", "steep", "diffuse", "colour", "background", "registers", "near_shade", "far_shade",
        "bands", "relief", "roughness", "roughness_hurst", "texture", "texture_from", "texture_seed", "cube_bits", "layout",
        "chunks", "chunk_edge", "chunk_colours", "texture_base", "texture_hurst", "texture_colours", "texels_per_metre",
        "mip", "trunk_base", "trunk_range", "trunk_distance", "fraction_bits", "guard_bits", "edge_fraction_bits", "variant",
        "colouring"}},
      raster_primitives_algorithm(),
      equalisation_algorithm(),
      zbuffer_views_algorithm(),
  };
  return list;
}

tools::Ucode half_space_program(const config::ParameterSet& parameters) {
  return assemble_for(kHalfSpace, parameters);
}

lib::ProgramImage program_image(const std::string& path, const config::ParameterSet& parameters) {
  return program_for({path.c_str(), "rds3000", path.c_str()}, parameters);
}

tools::Ucode hulls_program(const config::ParameterSet& parameters) { return assemble_for(kHulls, parameters); }

std::vector<Firmware> firmware_list() {
  std::vector<Firmware> list;
  for (const Source& source : kSources) {
    for (const char* pack : kPacks) {
      tools::AssembleOptions options;
      options.pack = pack;
      const tools::Ucode ucode = assemble_source(source, options).ucode;
      list.push_back({source.name, source.machine, source.path, pack, base::sha256(tools::write_ucode(ucode)),
                      ucode.words.size()});
    }
  }
  for (const int ports : {1, 2}) {
    half_space::ArraySite site;
    site.ports = ports;
    const lib::IgcPrograms programs = planes_programs(site, {});
    list.push_back({"half_space", kPixelPlanes, programs.name, fmt::format("{}p", ports), programs.sha256, programs.words.size()});
  }
  for (Firmware& firmware : raster_primitives_firmware()) list.push_back(std::move(firmware));
  list.push_back(equalisation_firmware());
  for (Firmware& firmware : zbuffer_views_firmware()) list.push_back(std::move(firmware));
  return list;
}

}  // namespace dendro::study
