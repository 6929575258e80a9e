#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "firmware/half_space/host/texture_program.h"
#include "models/parts/bps32/bps32_isa.h"
#include "sim/base/check.h"
#include "sim/study/table_fg86.h"
#include "sim/study/table_probe.h"

namespace dendro::study {
namespace {

using half_space::TextureKind;
using half_space::TextureSettings;

constexpr const char* kTexture = "firmware/half_space/rds3000/texture.gia";
constexpr unsigned kBits = 5;  ///< 32 texels a side
constexpr double kTexels = 32.0 * 32 * 32;
constexpr double kFrames = 60;  ///< a second
constexpr std::uint32_t kFrame = 512;

/// A cube with everything else as a scene leaves it.
TextureSettings settings_of(TextureKind kind, bool wide) {
  scene::Options options("half_space");
  scene::Image image;
  image.width = kFrame, image.height = kFrame / 2;
  TextureSettings settings = half_space::read_texture(options, image, wide ? 32 : 24, 1);
  settings.kind = kind, settings.bits = kBits, settings.wide = wide;
  return settings;
}

/// The paper's 24-bit machine makes a cube in the half of its memory that the picture leaves free.
Probe build_probe(const std::string& name, TextureKind kind) {
  const auto run = [=](HostPort& host, lib::RdsDriver& driver, const lib::ProgramImage& image,
                       Probe::Facts&) {
    half_space::build(host, driver, image, settings_of(kind, false), half_space::cube_layout(kBits, false));
  };
  return {name, "rds3000:fg86", kTexture, run, {}};
}

double without_levels(const stats::RunObject& run) {
  return machine_seconds(run) - phase_seconds(run, "mip");
}

void fill_generation(const TableContext& context, std::vector<TableRow>& rows) {
  const std::vector<Metric> metrics = {
      {"cube", without_levels},
      {"levels", machine_seconds},
      {"rate", [](const stats::RunObject& run) { return kTexels / without_levels(run) / kFrames; }}};
  const Propagated chunks =
      propagate_probe(context, build_probe("FG86 chunks", TextureKind::kChunks), metrics);
  const Propagated fbm = propagate_probe(context, build_probe("FG86 fbm", TextureKind::kFbm), metrics);
  set_metric(rows[0], chunks, metrics, 0);
  set_metric(rows[1], fbm, metrics, 0);
  set_metric(rows[2], fbm, metrics, 1);
  set_metric(rows[3], fbm, metrics, 2);
  for (std::size_t i = 0; i < rows.size(); ++i)
    rows[i].assumptions.insert(rows[i].assumptions.begin(), i == 0 ? "DEV-051" : "DEV-050");
  const auto ticks = [](const Propagated& p) {
    return without_levels(p.nominal) * p.nominal.clock_hz / kTexels;
  };
  rows[0].note = fmt::format(
      "32^3 texels, 1,000 chunks of edge 2 (DEV-051): {:.0f} ticks a texel, the paper 153: filling a cube "
      "and placing small "
      "blocks is less work than the paper's second has room for; fBm is not",
      ticks(chunks));
  rows[1].note = fmt::format(
      "32^3 texels, midpoint displacement (DEV-050): {:.0f} ticks a texel, the paper 153; a texel is made "
      "from 8 bytes "
      "around it, each read from the image memory",
      ticks(fbm));
  rows[2].note = fmt::format("the coarser levels alone take {:.2f} s", phase_seconds(fbm.nominal, "mip"));
  rows[3].note = fmt::format(
      "chunks: {:.0f}; 80,000 tree pixels a frame stay out of reach either way, so the paper computes the "
      "texture "
      "beforehand",
      metrics[2].of(chunks.nominal));
}

void read_byte_plane(HostPort& host, std::vector<std::uint8_t>& bytes) {
  std::vector<std::uint32_t> line(kFrame);
  bytes.clear();
  for (std::uint32_t y = 0; y < kFrame; ++y) {
    host.dma_from(y << 11, line.data(), line.size(), bps32::kFnLores, 2);
    for (const std::uint32_t word : line) bytes.push_back(static_cast<std::uint8_t>(word >> 24));
  }
}

/// Makes the cube over zeros and over ones: a pixel whose fourth byte is the same after both belongs to it.
Probe place_probe() {
  const auto run = [](HostPort& host, lib::RdsDriver& driver, const lib::ProgramImage& image,
                      Probe::Facts& facts) {
    const TextureSettings settings = settings_of(TextureKind::kChunks, true);
    const half_space::CubeLayout layout = half_space::cube_layout(kBits, true);
    std::vector<std::uint8_t> first, second;
    half_space::build(host, driver, image, settings, layout);
    read_byte_plane(host, first);
    const std::vector<std::uint32_t> ones(kFrame, ~0u);
    for (std::uint32_t y = 0; y < kFrame; ++y)
      host.dma_to(y << 11, ones.data(), ones.size(), bps32::kFnLores, 2);
    half_space::build(host, driver, image, settings, layout);
    read_byte_plane(host, second);
    double finest = 0, all = 0, finest_last = 0, last = 0;
    const std::uint32_t level_1 = layout.levels.at(1).base;
    for (std::uint32_t i = 0; i < first.size(); ++i) {
      if (first[i] != second[i]) continue;
      ++all, last = i;
      if (i < level_1) ++finest, finest_last = i;
    }
    facts = {{"finest", finest},
             {"all", all},
             {"finest_bits", std::floor(std::log2(finest_last)) + 1},
             {"bits", std::floor(std::log2(last)) + 1}};
  };
  return {"FG86 cube", "rds3000:32-bit", kTexture, run, {}};
}

void fill_places(const TableContext& context, std::vector<TableRow>& rows) {
  const stats::RunObject run = probe_counts(context, place_probe());
  const double finest = error_figure(run, "finest"), all = error_figure(run, "all");
  set_single(rows[0], finest);
  rows[0].note = fmt::format(
      "{:.4g} % of 512x512; pixels whose fourth byte the program writes, on the machine with 32 bits",
      100 * finest / (kFrame * kFrame));
  set_single(rows[1], all);
  rows[1].note =
      fmt::format("{:.3g} % of 512x512, with all {} levels", 100 * all / (kFrame * kFrame), kBits + 1);
  set_single(rows[2], error_figure(run, "finest_bits"));
  rows[2].note = "9 of the column and 8 of the row";
  set_single(rows[3], error_figure(run, "bits"));
  rows[3].note = "FG86-K15: the row needs 9 bits once coarser levels are stored";
}

}  // namespace

std::vector<RowGroup> fg86_texture_groups() {
  return {{"texture.gia makes a cube, nominal and over every assumption, chunks and fBm",
           {claim("FG86-A9a", "texture generation, chunks", "s", 1.0),
            claim("FG86-A9b", "texture generation, fBm", "s", 1.0),
            claim("FG86-A9c", "texture generation, fBm, and its MIP levels", "s", 1.0),
            claim("FG86-A28b", "texels made in 1/60 s, fBm", "1", 4900.0, "the STINT's 70x70 in real time")},
           fill_generation},
          {"texture.gia on the machine with 32 bits, the pixels it writes counted",
           {claim("FG86-A13", "pixels of a cube of 32x32x32 texels", "1", 131072.0),
            claim("FG86-A14", "pixels of the cube and its MIP levels", "1", 149796.0,
                  "\"will not even fill the buffer\": fewer than 262,144; the sum of the levels shown"),
            claim("FG86-A15a", "bits of a texel's address, cube alone", "1", 17.0,
                  "lower 9 bits and upper 8 bits"),
            claim("FG86-A15b", "bits of a texel's address with MIP levels", "1", 17.0,
                  "lower 9 bits and upper 8 bits")},
           fill_places}};
}

}  // namespace dendro::study
