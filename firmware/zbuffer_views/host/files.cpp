#include "firmware/zbuffer_views/host/files.h"

#include <fmt/format.h>

#include <cstring>
#include <string_view>
#include <type_traits>

#include "firmware/zbuffer_views/host/words.h"
#include "firmware/zbuffer_views/reference/directions.h"
#include "firmware/zbuffer_views/sgi_4d35/format.h"
#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/base/sha256.h"

namespace dendro::zbuffer_views {
namespace {

void put_word(Bytes& file, std::uint32_t word) {
  for (int shift = 24; shift >= 0; shift -= 8) file.push_back(static_cast<std::uint8_t>(word >> shift));
}

/// A structure of 32-bit words, big-endian.
template <class T>
void put(Bytes& file, const T& value) {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % 4 == 0);
  for (std::size_t i = 0; i < sizeof(T); i += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, reinterpret_cast<const char*>(&value) + i, 4);
    put_word(file, word);
  }
}

void put_vector(float to[3], const glm::dvec3& v) {
  for (int i = 0; i < 3; ++i) to[i] = static_cast<float>(v[i]);
}

std::uint32_t packed(const Rgb& rgb) { return std::uint32_t{rgb[0]} << 16 | std::uint32_t{rgb[1]} << 8 | rgb[2]; }

zbv_head head_of(std::uint32_t magic, std::size_t bytes, const Digest& digest) {
  zbv_head head{magic, kZbvVersion, static_cast<std::uint32_t>(bytes), {}};
  for (std::size_t i = 0; i < digest.size(); ++i) head.digest[i] = digest[i];
  return head;
}

bool same_digest(const zbv_head& head, const Digest& digest) {
  return std::memcmp(head.digest, digest.data(), sizeof head.digest) == 0;
}

Digest digest_of_rest(const Bytes& file) {
  const auto* text = reinterpret_cast<const char*>(file.data());
  const std::string hex = base::sha256(std::string_view(text, file.size()).substr(sizeof(zbv_head)));
  Digest digest{};
  for (std::size_t i = 0; i < digest.size(); ++i)
    digest[i] = static_cast<std::uint32_t>(std::stoul(hex.substr(8 * i, 8), nullptr, 16));
  return digest;
}

}  // namespace

Bytes tree_file(const Tree& tree) {
  const TreeModel& model = tree.model;
  Bytes file;
  zbv_tree facts{};
  facts.vertices = static_cast<std::uint32_t>(model.vertices.size());
  facts.triangles = static_cast<std::uint32_t>(model.triangles.size());
  facts.colours = static_cast<std::uint32_t>(tree.colours.size());
  put_vector(facts.centre, tree.centre);
  const std::size_t bytes = sizeof facts + tree.colours.size() * sizeof(zbv_colour) +
                            model.vertices.size() * sizeof(float[3]) + model.triangles.size() * sizeof(zbv_triangle);
  file.reserve(bytes);
  put(file, facts);
  for (const Colour& colour : tree.colours)
    put(file, zbv_colour{static_cast<std::uint32_t>(colour.part), packed(colour.rgb), static_cast<std::uint32_t>(colour.below), 0});
  for (const glm::dvec3& p : model.vertices) {
    std::array<float, 3> vertex;
    put_vector(vertex.data(), p);
    put(file, vertex);
  }
  for (std::size_t i = 0; i < model.triangles.size(); ++i) {
    const auto& t = model.triangles[i];
    put(file, zbv_triangle{{t[0], t[1], t[2]}, tree.colour_of[i]});
  }
  Bytes head;
  put(head, head_of(kZbvTreeMagic, bytes, digest_of_rest(file)));
  std::copy(head.begin(), head.end(), file.begin());
  return file;
}

Digest digest_of(const Bytes& tree_file) {
  const auto head = get<zbv_head>(tree_file, 0);
  return {head.digest[0], head.digest[1], head.digest[2], head.digest[3]};
}

Bytes job_file(const Prepared& p, const Digest& digest, std::size_t first, std::size_t count) {
  zbv_job job{};
  const auto unsigned_of = [](int v) { return static_cast<std::uint32_t>(v); };
  const auto single = [](double v) { return static_cast<float>(v); };
  const std::size_t bytes = sizeof job + p.placements.size() * sizeof(zbv_placement) + count * sizeof(zbv_frame);
  job.head = head_of(kZbvJobMagic, bytes, digest);
  job.bands = unsigned_of(p.views.bands), job.layers = unsigned_of(p.views.layers);
  job.view_width = unsigned_of(p.views.width), job.view_height = unsigned_of(p.views.height);
  job.rule = p.views.peel ? kZbvPeel : kZbvInsert;
  job.leaf_side = p.views.early ? kZbvEarly : kZbvLate;
  job.pitch = single(p.views.pitch), job.threshold = single(p.views.threshold);
  job.width = unsigned_of(p.width), job.height = unsigned_of(p.height);
  job.projection = p.perspective ? kZbvPerspective : kZbvParallel;
  job.scale = single(p.scale), job.centre_x = single(p.centre_x), job.centre_y = single(p.centre_y), job.near = single(p.near);
  job.ambient = single(p.ambient), job.diffuse = single(p.diffuse);
  job.background = packed(p.background);
  job.shadows = p.shadows;
  job.light_width = unsigned_of(p.light_width), job.light_height = unsigned_of(p.light_height);
  job.light_scale = single(p.light_scale), job.epsilon = single(p.epsilon);
  job.options = p.skip_empty * unsigned_of(kZbvSkipEmpty) | p.full_product * unsigned_of(kZbvFullProduct) |
                p.reuse_light * unsigned_of(kZbvReuseLight);
  job.trees = static_cast<std::uint32_t>(p.placements.size());
  job.frames = static_cast<std::uint32_t>(count);
  Bytes file;
  put(file, job);
  for (const Placement& placement : p.placements) {
    zbv_placement place{};
    put_vector(place.at, placement.at);
    place.turn = unsigned_of(placement.turn);
    put(file, place);
  }
  for (std::size_t i = first; i < first + count; ++i) {
    const Frame& from = p.frames[i];
    zbv_frame frame{};
    put_vector(frame.eye, from.eye);
    put_vector(frame.frame, from.axes.right);
    put_vector(frame.frame + 3, from.axes.up);
    put_vector(frame.frame + 6, from.axes.forward);
    put_vector(frame.light, from.to_light);
    put(file, frame);
  }
  DENDRO_CHECK(file.size() == bytes, "{} {}", file.size(), bytes);
  return file;
}

std::string views_made_from(const Bytes& tree, const ViewSettings& v) {
  return fmt::format("{} {} {} {} {} {:a} {:a} {} {}", base::sha256(std::string_view(reinterpret_cast<const char*>(tree.data()), tree.size())), v.bands,
                     v.layers, v.width, v.height, v.pitch, v.threshold, v.peel, v.early);
}

namespace {

/// `file` is the start of one of `size` bytes.
ViewsFacts check_start(const Bytes& file, std::size_t size, const Prepared& p, const Digest& digest, const std::string& path) {
  const auto fail = [&](const std::string& message) { throw UserError(path, 0, "", message); };
  if (file.size() < sizeof(zbv_head) || word_at(file, 0) != kZbvViewsMagic) fail("is no file of stored views");
  const auto head = get<zbv_head>(file, 0);
  if (head.version != kZbvVersion) fail(fmt::format("has version {}, this dendro reads {}", head.version, int(kZbvVersion)));
  if (head.bytes != size || file.size() < sizeof(zbv_views))
    fail(fmt::format("is truncated or damaged: {} bytes instead of {}", size, head.bytes));
  if (!same_digest(head, digest)) fail("holds views of another tree than the scene's");
  const auto facts = get<zbv_views>(file, 0);
  const auto want = [&](const char* what, double has, double wanted) {
    if (has != wanted) fail(fmt::format("{}: its views have {}, the scene wants {}", what, has, wanted));
  };
  want("bands", facts.bands, p.views.bands);
  want("layers", facts.layers, p.views.layers);
  want("view_width", facts.width, p.views.width);
  want("view_height", facts.height, p.views.height);
  want("rule", facts.rule, p.views.peel ? kZbvPeel : kZbvInsert);
  want("leaf_side", facts.leaf_side, p.views.early ? kZbvEarly : kZbvLate);
  want("threshold", facts.threshold, p.views.threshold);
  if (p.views.pitch > 0) want("pitch", facts.pitch, p.views.pitch);
  const std::size_t samples = std::size_t{facts.width} * facts.height * facts.layers * facts.views;
  const std::size_t bytes = sizeof facts + facts.colours * sizeof(zbv_colour) + facts.views * sizeof(zbv_view) + samples * kZbvSampleBytes;
  if (facts.views != view_directions(p.views.bands).size() || bytes != size)
    fail(fmt::format("is damaged: its counts need {} bytes, it has {}", bytes, size));
  return {facts.views, facts.pitch};
}

}  // namespace

ViewsFacts check_views(const base::ScratchFile& file, const Prepared& p, const Digest& digest, const std::string& path) {
  return check_start(file.start(sizeof(zbv_views)), file.size(), p, digest, path);
}

ViewsFacts check_views(const Bytes& file, const Prepared& p, const Digest& digest, const std::string& path) {
  return check_start(file, file.size(), p, digest, path);
}

std::vector<DrawnPicture> read_pictures(const Bytes& file, const Prepared& p, const Digest& digest) {
  const auto pixels = static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height);
  DENDRO_CHECK(file.size() >= sizeof(zbv_pictures), "{} bytes", file.size());
  const auto facts = get<zbv_pictures>(file, 0);
  DENDRO_CHECK(facts.head.magic == kZbvPicturesMagic && facts.head.version == kZbvVersion && same_digest(facts.head, digest));
  const std::size_t each = sizeof(zbv_picture) + pixels * 8;
  DENDRO_CHECK(facts.head.bytes == file.size() && file.size() == sizeof facts + facts.frames * each, "{} bytes", file.size());
  std::vector<DrawnPicture> pictures(facts.frames);
  std::size_t at = sizeof facts;
  for (DrawnPicture& picture : pictures) {
    const auto counts = get<zbv_picture>(file, at);
    picture.covered = counts.covered, picture.shadowed = counts.shadowed;
    picture.camera_views = counts.camera_views, picture.light_views = counts.light_views;
    at += sizeof counts;
    picture.depth.resize(pixels), picture.rgb.resize(3 * pixels);
    for (std::size_t i = 0; i < pixels; ++i) picture.depth[i] = get<float>(file, at + 4 * i);
    at += 4 * pixels;
    for (std::size_t channel = 0; channel < 3; ++channel, at += pixels)
      for (std::size_t i = 0; i < pixels; ++i) picture.rgb[3 * i + channel] = file[at + i];
    const auto from = file.begin() + static_cast<std::ptrdiff_t>(at);
    picture.colour.assign(from, from + static_cast<std::ptrdiff_t>(pixels));
    at += pixels;
  }
  return pictures;
}

}  // namespace dendro::zbuffer_views
