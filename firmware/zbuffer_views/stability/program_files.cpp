#include "firmware/zbuffer_views/stability/program_files.h"

#include <cmath>
#include <cstring>
#include <random>
#include <stdexcept>

#include "sim/base/sha256.h"

namespace dendro::zbuffer_views {
namespace {

constexpr std::size_t kWord = 4;

void put_words(std::string& to, const void* from, std::size_t bytes) {
  const auto* at = static_cast<const unsigned char*>(from);
  for (std::size_t i = 0; i < bytes; i += kWord)
    for (std::size_t k = 0; k < kWord; ++k) to += static_cast<char>(at[i + 3 - k]);
}

template <typename T>
void put(std::string& to, const T& value) {
  put_words(to, &value, sizeof value);
}
template <typename T>
void put(std::string& to, const std::vector<T>& values) {
  put_words(to, values.data(), values.size() * sizeof(T));
}
void put_bytes(std::string& to, const std::vector<std::uint8_t>& values) {
  to.append(values.begin(), values.end());
}

class Reader {
 public:
  explicit Reader(const std::string& bytes) : bytes_(bytes) {}
  void words(void* to, std::size_t bytes) {
    need(bytes);
    auto* out = static_cast<unsigned char*>(to);
    for (std::size_t i = 0; i < bytes; i += kWord, at_ += kWord)
      for (std::size_t k = 0; k < kWord; ++k) out[i + 3 - k] = static_cast<unsigned char>(bytes_[at_ + k]);
  }
  template <typename T>
  void read(T& value) {
    words(&value, sizeof value);
  }
  template <typename T>
  void read(std::vector<T>& values, std::size_t count) {
    values.resize(count);
    words(values.data(), count * sizeof(T));
  }
  void bytes(std::vector<std::uint8_t>& values, std::size_t count) {
    need(count);
    values.assign(bytes_.begin() + static_cast<std::ptrdiff_t>(at_),
                  bytes_.begin() + static_cast<std::ptrdiff_t>(at_ + count));
    at_ += count;
  }
  void end() const {
    if (at_ != bytes_.size()) throw std::runtime_error("bytes are left");
  }

 private:
  void need(std::size_t bytes) const {
    if (bytes > bytes_.size() - at_) throw std::runtime_error("bytes are missing");
  }
  const std::string& bytes_;
  std::size_t at_ = 0;
};

std::string with_length(std::string bytes) {
  std::string length;
  put(length, static_cast<std::uint32_t>(bytes.size()));
  return bytes.replace(8, 4, length);
}

std::string tree_body(const TreeFile& tree) {
  zbv_tree facts = {};
  facts.vertices = static_cast<std::uint32_t>(tree.vertices.size());
  facts.triangles = static_cast<std::uint32_t>(tree.triangles.size());
  facts.colours = static_cast<std::uint32_t>(tree.colours.size());
  for (std::size_t i = 0; i < 3; ++i) facts.centre[i] = tree.centre[i];
  std::string all;
  put(all, facts);
  put(all, tree.colours);
  put(all, tree.vertices);
  put(all, tree.triangles);
  return all.substr(sizeof(zbv_head));
}

using Real3 = std::array<double, 3>;
Real3 cross(const Real3& a, const Real3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Real3 unit(const Real3& a) {
  const double size = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
  return {a[0] / size, a[1] / size, a[2] / size};
}

}  // namespace

void TreeFile::add(const Vertex& a, const Vertex& b, const Vertex& c, std::uint32_t colour) {
  const auto first = static_cast<std::uint32_t>(vertices.size());
  vertices.insert(vertices.end(), {a, b, c});
  triangles.push_back({{first, first + 1, first + 2}, colour});
}

std::array<std::uint32_t, kZbvDigestWords> TreeFile::digest() const {
  const std::string hex = base::sha256(tree_body(*this));
  std::array<std::uint32_t, kZbvDigestWords> words;
  for (std::size_t i = 0; i < words.size(); ++i)
    words[i] = static_cast<std::uint32_t>(std::stoul(hex.substr(8 * i, 8), nullptr, 16));
  return words;
}

std::string TreeFile::bytes() const {
  zbv_head head = {kZbvTreeMagic, kZbvVersion, 0, {}};
  const auto words = digest();
  std::copy(words.begin(), words.end(), head.digest);
  std::string all;
  put(all, head);
  return with_length(all + tree_body(*this));
}

TreeFile random_tree(std::uint32_t seed, int leaves) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) {
    return static_cast<float>(low + (high - low) * (random() >> 8) / 16777216.0);
  };
  TreeFile tree;
  tree.colours.push_back({kZbvTrunk, 0x7A5A3A, 2, 0});
  for (int k = 0; k < 6; ++k) {
    const auto corner = [&](int i, float y, float r) -> Vertex {
      const double angle = i * 1.0471975511965976;
      return {static_cast<float>(r * std::sin(angle)), y, static_cast<float>(r * std::cos(angle))};
    };
    const Vertex a = corner(k, -1.5f, 0.15f), b = corner(k + 1, -1.5f, 0.15f), c = corner(k + 1, 1, 0.05f),
                 d = corner(k, 1, 0.05f);
    tree.add(a, b, c, 2);
    tree.add(a, c, d, 2);
  }
  for (int i = 0; i < leaves; ++i) {
    const Vertex at = {between(-0.7, 0.7), between(-0.7, 1.2), between(-0.7, 0.7)};
    const auto near = [&]() -> Vertex {
      return {at[0] + between(-0.2, 0.2), at[1] + between(-0.2, 0.2), at[2] + between(-0.2, 0.2)};
    };
    const Vertex b = near(), c = near();
    tree.add(at, b, c, 0);
  }
  return tree;
}

JobFile::JobFile(const TreeFile& tree) {
  facts.head = {kZbvJobMagic, kZbvVersion, 0, {}};
  const auto words = tree.digest();
  std::copy(words.begin(), words.end(), facts.head.digest);
  facts.bands = 3;
  facts.layers = 2;
  facts.view_width = 60;
  facts.view_height = 80;
  facts.threshold = 0.03f;
  facts.width = 48;
  facts.height = 64;
  facts.scale = 20;
  facts.centre_x = 23.5f;
  facts.centre_y = 31.5f;
  facts.near = 0.1f;
  facts.ambient = 0.3f;
  facts.diffuse = 0.7f;
  facts.background = 0x102030;
  facts.light_width = facts.light_height = 64;
  facts.epsilon = 2.6f;
  frames = {look({0, 0, 8}, {0, 0, 0}, {0.48, 0.64, 0.6})};
}

std::string JobFile::bytes() const {
  zbv_job head = facts;
  head.trees = static_cast<std::uint32_t>(trees.size());
  head.frames = static_cast<std::uint32_t>(frames.size());
  std::string all;
  put(all, head);
  put(all, trees);
  put(all, frames);
  return with_length(all);
}

zbv_frame look(const std::array<double, 3>& eye, const std::array<double, 3>& target,
               const std::array<double, 3>& light) {
  const Real3 forward = unit({target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]});
  const Real3 right = unit(cross(forward, {0, 1, 0})), up = cross(right, forward), sun = unit(light);
  zbv_frame frame = {};
  for (std::size_t i = 0; i < 3; ++i) {
    frame.eye[i] = static_cast<float>(eye[i]);
    frame.frame[i] = static_cast<float>(right[i]);
    frame.frame[3 + i] = static_cast<float>(up[i]);
    frame.frame[6 + i] = static_cast<float>(forward[i]);
    frame.light[i] = static_cast<float>(sun[i]);
  }
  return frame;
}

ViewsFile ViewsFile::parse(const std::string& bytes) {
  ViewsFile file;
  Reader reader(bytes);
  reader.read(file.facts);
  reader.read(file.colours, file.facts.colours);
  reader.read(file.views, file.facts.views);
  const std::size_t samples = file.facts.width * file.facts.height;
  file.layers.assign(file.facts.views, std::vector<Layer>(file.facts.layers));
  for (auto& view : file.layers)
    for (Layer& layer : view) {
      reader.read(layer.z, samples);
      reader.bytes(layer.latitude, samples);
      reader.bytes(layer.longitude, samples);
      reader.bytes(layer.colour, samples);
    }
  reader.end();
  return file;
}

std::string ViewsFile::bytes() const {
  std::string all;
  put(all, facts);
  put(all, colours);
  put(all, views);
  for (const auto& view : layers)
    for (const Layer& layer : view) {
      put(all, layer.z);
      put_bytes(all, layer.latitude);
      put_bytes(all, layer.longitude);
      put_bytes(all, layer.colour);
    }
  return with_length(all);
}

void ViewsFile::make_empty() {
  const std::size_t samples = facts.width * facts.height;
  for (auto& view : layers)
    for (Layer& layer : view)
      layer = {std::vector<float>(samples, kZbvEmptyDepth), std::vector<std::uint8_t>(samples, 0),
               std::vector<std::uint8_t>(samples, 0), std::vector<std::uint8_t>(samples, kZbvEmptyColour)};
}

Pictures Pictures::parse(const std::string& bytes) {
  Pictures file;
  Reader reader(bytes);
  reader.read(file.facts);
  const std::size_t pixels = file.facts.width * file.facts.height;
  for (std::uint32_t i = 0; i < file.facts.frames; ++i) {
    Picture picture;
    reader.read(picture.facts);
    reader.read(picture.depth, pixels);
    for (auto* plane : {&picture.red, &picture.green, &picture.blue, &picture.colour})
      reader.bytes(*plane, pixels);
    file.pictures.push_back(std::move(picture));
  }
  reader.end();
  return file;
}

}  // namespace dendro::zbuffer_views
