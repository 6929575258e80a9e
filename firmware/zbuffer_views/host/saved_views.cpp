#include "firmware/zbuffer_views/host/saved_views.h"

#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "firmware/zbuffer_views/host/words.h"
#include "firmware/zbuffer_views/sgi_4d35/format.h"
#include "sim/base/error.h"

namespace dendro::zbuffer_views {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kChecksumAt = sizeof(zbv_views) + offsetof(zbv_colour, checksum);
constexpr std::size_t kPieceBytes = 1 << 20;

void set_word(base::ScratchFile& views, std::uint32_t word) {
  std::array<std::uint8_t, 4> bytes;
  for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<std::uint8_t>(word >> (24 - 8 * i));
  views.write(kChecksumAt, bytes.data(), bytes.size());
}

std::uint32_t crc_of(const base::ScratchFile& views) {
  Bytes piece(kPieceBytes);
  uLong crc = crc32(0, nullptr, 0);
  for (std::size_t at = 0, n = 0; (n = views.read(at, piece.data(), piece.size())) > 0; at += n)
    crc = crc32(crc, piece.data(), static_cast<uInt>(n));
  return static_cast<std::uint32_t>(crc);
}

[[noreturn]] void fail(const std::string& path, const std::string& what) { throw UserError(path, 0, "", "is damaged: " + what); }

bool finite(const float* values, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i)
    if (!std::isfinite(values[i])) return false;
  return true;
}

/// What stands before the planes.
void check_tables(const Bytes& start, const zbv_views& facts, const std::string& path) {
  if (!finite(&facts.pitch, 4)) fail(path, "a length in its head is not finite");
  for (std::uint32_t i = 0; i < facts.colours; ++i) {
    const auto colour = get<zbv_colour>(start, sizeof facts + i * sizeof(zbv_colour));
    if (colour.part > kZbvLeaf || colour.below >= facts.colours || colour.rgb > 0xFFFFFF) fail(path, fmt::format("colour {} is none", i));
  }
  for (std::uint32_t i = 0; i < facts.views; ++i) {
    const auto view = get<zbv_view>(start, sizeof facts + facts.colours * sizeof(zbv_colour) + i * sizeof(zbv_view));
    if (!finite(&view.theta, 4) || !finite(view.frame, 9)) fail(path, fmt::format("view {} holds a value that is not finite", i));
  }
}

/// One layer of one view. Returns what is wrong, "" if nothing.
std::string layer_error(const Bytes& planes, std::size_t samples, std::uint32_t colours) {
  for (std::size_t i = 0; i < samples; ++i) {
    const auto z = get<std::array<float, 1>>(planes, 4 * i)[0];
    const std::uint8_t colour = planes[6 * samples + i];
    if ((z == kZbvEmptyDepth) != (colour == kZbvEmptyColour)) return fmt::format("sample {} is half empty", i);
    if (colour == kZbvEmptyColour) continue;
    if (colour >= colours) return fmt::format("sample {} has colour {} of {}", i, colour, colours);
    if (!(std::abs(z) < kZbvFarDepth)) return fmt::format("sample {} has the depth {}", i, z);
  }
  return "";
}

}  // namespace

void put_checksum(base::ScratchFile& views) { set_word(views, crc_of(views)); }
void take_checksum(base::ScratchFile& views) { set_word(views, 0); }

void check_saved_views(base::ScratchFile& views, const std::string& path) {
  const auto facts = get<zbv_views>(views.start(sizeof(zbv_views)), 0);
  if (facts.colours < 1 || facts.colours > kZbvMostColours) fail(path, fmt::format("it has {} colours", facts.colours));
  const std::size_t tables = sizeof facts + facts.colours * sizeof(zbv_colour) + facts.views * sizeof(zbv_view);
  const Bytes start = views.start(tables);
  const std::uint32_t checksum = word_at(start, kChecksumAt);
  take_checksum(views);
  if (checksum != 0 && crc_of(views) != checksum) fail(path, "its content does not have the checksum that it names");
  check_tables(start, facts, path);
  const std::size_t samples = std::size_t{facts.width} * facts.height;
  Bytes planes(samples * kZbvSampleBytes);
  for (std::size_t i = 0; i < std::size_t{facts.views} * facts.layers; ++i) {
    views.read(tables + i * planes.size(), planes.data(), planes.size());
    const std::string wrong = layer_error(planes, samples, facts.colours);
    if (!wrong.empty()) fail(path, fmt::format("view {}, layer {}: {}", i / facts.layers, i % facts.layers, wrong));
  }
}

}  // namespace dendro::zbuffer_views
