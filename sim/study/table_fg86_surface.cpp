#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/half_space/host/colour_program.h"
#include "firmware/half_space/host/roughen_program.h"
#include "firmware/half_space/host/seeds.h"
#include "models/parts/bps32/bps32_isa.h"
#include "sim/base/check.h"
#include "sim/study/table_fg86.h"
#include "sim/study/table_probe.h"

namespace dendro::study {
namespace {

using half_space::Colouring;

constexpr const char* kMachine = "rds3000:fg86";
constexpr const char* kRoughen = "firmware/half_space/rds3000/roughen.gia";
constexpr const char* kColour = "firmware/half_space/rds3000/colour.gia";
constexpr int kObject = 250;  ///< pixels a side of what FG86 6.2 times
constexpr double kPixels = double(kObject) * kObject;
constexpr double kFrames = 60;  ///< a second, "real time" in FG86 6.3

/// The same word into every pixel of the first lines.
void put_pixels(HostPort& host, int width, int height, std::uint32_t word) {
  const std::vector<std::uint32_t> line(static_cast<std::size_t>(width), word);
  for (int y = 0; y < height; ++y)
    host.dma_to(static_cast<std::uint32_t>(y) << 11, line.data(), line.size(), bps32::kFnLores, 2);
}

/// Roughens a box of 250 x 250 pixels that all hold this front and back.
Probe roughen_probe(const std::string& name, std::uint32_t front, std::uint32_t back) {
  const auto run = [=](HostPort& host, lib::RdsDriver& driver, const lib::ProgramImage& image,
                       Probe::Facts&) {
    put_pixels(host, kObject, kObject, front | back << 8);
    half_space::run_roughen(
        driver, image,
        half_space::make_roughening({0.05, 0.5}, 200, {0, 0, kObject - 1, kObject - 1}, 255, 1, 1));
  };
  return {name, kMachine, kRoughen, run, {}};
}

void fill_roughening(const TableContext& context, std::vector<TableRow>& rows) {
  const std::vector<Metric> metrics = {
      {"roughen", machine_seconds},
      {"pixel", [](const stats::RunObject& run) { return machine_seconds(run) * run.clock_hz / kPixels; }}};
  const Propagated covered = propagate_probe(context, roughen_probe("FG86 roughen", 100, 250), metrics);
  const Propagated empty = propagate_probe(context, roughen_probe("FG86 roughen empty", 0, 0), metrics);
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    set_metric(rows[i], covered, metrics, i);
    rows[i].assumptions.insert(rows[i].assumptions.begin(), "DEV-053");
  }
  rows[0].note = fmt::format(
      "every pixel of the box covered; {:.3f} s when none is. The field is a tile of 64 x 64 that repeats "
      "(DEV-053), made "
      "once in {:.3f} s; interpolation or a random number for each pixel would account for more",
      metrics[0].of(empty.nominal), phase_seconds(covered.nominal, "grow"));
  rows[1].note = fmt::format("{:.1f} for an empty pixel; 80 are the paper's 1.0 s over 62,500 pixels",
                             metrics[1].of(empty.nominal));
}

/// The picture as colour.gia finds it: every pixel at one nearest depth.
Probe colour_probe(const std::string& name, int width, int height, std::uint32_t nearest) {
  const auto run = [=](HostPort& host, lib::RdsDriver& driver, const lib::ProgramImage& image,
                       Probe::Facts& facts) {
    put_pixels(host, width, height, nearest << 16);
    half_space::ColourSettings settings;
    settings.trunk_base = {60, 30, 10}, settings.trunk_range = {40, 20, 10};
    scene::Affine map;
    map.linear = {{0.5, 0.1, 0.2}, {-0.1, 0.5, 0.3}, {0.2, 0.2, 0.5}};
    const auto trunk = nearest == 0 ? static_cast<std::size_t>(width) * static_cast<std::size_t>(height) : 0;
    half_space::run_colour(driver, image,
                           half_space::make_colouring(settings, map, half_space::cube_layout(5, false), width,
                                                      height, trunk, 1, 2));
    std::array<double, 3> least = {255, 255, 255}, most = {0, 0, 0};
    std::vector<std::uint32_t> line(static_cast<std::size_t>(width));
    for (int y = 0; y < height; ++y) {
      host.dma_from(static_cast<std::uint32_t>(y) << 11, line.data(), line.size(), bps32::kFnLores, 2);
      for (const std::uint32_t word : line)
        for (std::size_t c = 0; c < 3; ++c) {
          const double value = word >> 8 * c & 0xFF;
          least[c] = std::min(least[c], value), most[c] = std::max(most[c], value);
        }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      facts.emplace_back(fmt::format("least.{}", c), least[c]);
      facts.emplace_back(fmt::format("most.{}", c), most[c]);
    }
  };
  return {name, kMachine, kColour, run, {}};
}

constexpr const char* kChannels[] = {"red", "green", "blue"};

/// A picture whose bark takes three whole seeds: 512 pixels.
void fill_bark(const TableContext& context, std::vector<TableRow>& rows) {
  Probe probe = colour_probe("FG86 bark", 32, 16, 0);
  probe.counted = [](const lib::ProgramImage& image) {
    return std::map<std::uint32_t, std::string>{{image.symbols.at("draw"), "draw"},
                                                {image.symbols.at("draw_reseed"), "seed"}};
  };
  const stats::RunObject run = probe_counts(context, probe);
  set_single(rows[0], executions(run, "draw") / executions(run, "seed"));
  rows[0].note = fmt::format(
      "{:g} numbers of {:g} seeds, counted while {} pixels of bark are drawn; the seeds' length is the "
      "paper's",
      executions(run, "draw"), executions(run, "seed"), 512);
  for (std::size_t c = 0; c < 3; ++c) {
    set_single(rows[c + 1], error_figure(run, fmt::format("most.{}", c)));
    rows[c + 1].note = fmt::format(
        "least {} {:g}; 512 pixels of bark as the machine leaves them, base and range the paper's",
        kChannels[c], error_figure(run, fmt::format("least.{}", c)));
  }
}

/// Multiplications, which shift, and additions between a coordinate and the address of its texel; the
/// additions that make the coordinates aside.
std::map<std::uint32_t, std::string> address_words(const lib::ProgramImage& image) {
  using namespace bps32;
  std::map<std::uint32_t, std::string> counted;
  bool shifted = false;
  for (std::uint32_t at = image.symbols.at("cube"); at < image.symbols.at("fetch_byte_0"); ++at) {
    const std::uint64_t word = image.words.at(at);
    const bool shifts = get(word, kMul) != kMulNone;
    const bool on_memory = get(word, kOeb) == 1 || get(word, kEa) == 1;
    const unsigned source = get(word, kDsrc);
    const bool coordinate = on_memory && (source == kDSpadAr || source == kDSpadArInc);
    const bool adds = shifted && get(word, kFunc) == kRPlusS && get(word, kI0) == 0 && !coordinate;
    shifted = shifted || shifts;
    if (shifts) counted[at] += "shift " + std::to_string(at);
    if (adds) counted[at] += " add " + std::to_string(at);
  }
  counted[image.symbols.at("cube")] += " texel";
  return counted;
}

void fill_address(const TableContext& context, std::vector<TableRow>& rows) {
  Probe probe = colour_probe("FG86 address", 64, 64, 100);
  probe.counted = address_words;
  double shifts = 0, adds = 0, texels = 0;
  const stats::RunObject run = probe_counts(context, probe);
  for (const auto& [name, count] : run.executions) {
    const auto number = static_cast<double>(count);
    if (name.find("shift") != std::string::npos) shifts += number;
    if (name.find("add") != std::string::npos) adds += number;
    if (name.find("texel") != std::string::npos) texels += number;
  }
  DENDRO_CHECK(texels == 64 * 64, "{}", texels);
  set_single(rows[0], shifts / texels);
  rows[0].note =
      "multiplications by powers of two, executed per texel; three AND masks for the modulo beside them";
  set_single(rows[1], adds / texels);
  rows[1].note =
      "executed per texel: the two of the formula join the coordinates; one adds the MIP level's place, two "
      "turn the "
      "pixel's number into the bus's address, which the formula leaves out";
}

void fill_mapping(const TableContext& context, std::vector<TableRow>& rows) {
  const std::vector<Metric> metrics = {
      {"pixels", [](const stats::RunObject& run) { return kPixels / machine_seconds(run) / kFrames; }}};
  const Propagated p = propagate_probe(context, colour_probe("FG86 colour", kObject, kObject, 100), metrics);
  set_metric(rows[0], p, metrics, 0);
  rows[0].assumptions.insert(rows[0].assumptions.begin(), "DEV-054");
  rows[0].note =
      fmt::format("{:.1f} ticks a pixel; {:.0f} frames for the tree pixels of one",
                  machine_seconds(p.nominal) * p.nominal.clock_hz / kPixels, 80000 / *rows[0].simulated);
}

}  // namespace

std::vector<RowGroup> fg86_surface_groups() {
  std::vector<TableRow> bark = {
      claim("FG86-A6", "numbers of one random seed", "1", 512.0, "one screen line")};
  constexpr double kMost[] = {100, 50, 20};
  for (std::size_t c = 0; c < 3; ++c)
    bark.push_back(claim(fmt::format("FG86-A27{}", static_cast<char>('a' + c)),
                         fmt::format("bark: largest {}", kChannels[c]), "1", kMost[c]));
  return {{"roughen.gia on a box of 250x250 pixels, nominal and over every assumption",
           {claim("FG86-A8a", "roughening of 250x250 pixels", "s", 1.0),
            claim("FG86-A8b", "roughening of one pixel", "tick", 80.0)},
           fill_roughening},
          {"colour.gia on 512 pixels of bark, its random numbers counted", std::move(bark), fill_bark},
          {"colour.gia on textured pixels, its address words counted",
           {claim("FG86-A16a", "shifts for the address of a texel", "1", 3.0),
            claim("FG86-A16b", "additions for the address of a texel", "1", 2.0)},
           fill_address},
          {"colour.gia on 250x250 textured pixels, nominal and over every assumption",
           {claim("FG86-A28a", "tree pixels textured in 1/60 s", "1", 80000.0,
                  "what 200 trees of 20x20 pixels need at 60 frames a second")},
           fill_mapping}};
}

}  // namespace dendro::study
