#include "sim/scene/image_io.h"

#include <cstdio>
#include <cstring>
#include <fstream>
#include <string_view>

#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/base/sha256.h"
#include "sim/scene/picture_process.h"

namespace dendro::scene {
namespace {

void write_file(const std::string& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (file) return;
  std::remove(path.c_str());
  throw UserError(path, 0, {}, "cannot write here: the disk is full or the folder is missing or read-only");
}

}  // namespace

void write_png(const std::string& path, const RgbImage& image) {
  DENDRO_CHECK(image.rgb.size() == std::size_t(image.width) * image.height * 3);
  write_file(path, picture_work({{"work", "encode rgb"}, {"width", image.width}, {"height", image.height}}, path,
                                {{image.rgb.data(), image.rgb.size()}})
                       .bytes);
}

void write_animation(const std::string& path, const std::vector<std::string>& pictures, double pictures_a_second) {
  DENDRO_CHECK(!pictures.empty());
  picture_work({{"work", "write animation"}, {"pictures", pictures}, {"pictures_a_second", pictures_a_second}}, path);
}

RgbImage read_rgb(const std::string& path) { return read_frame(path, 0); }

RgbImage read_frame(const std::string& path, int number) {
  const PictureMessage read = picture_work({{"work", "read rgb"}, {"number", number}}, path);
  const std::size_t channels = read.head["channels"].size();
  RgbImage image{read.head["width"], read.head["height"], {}};
  image.rgb.resize(std::size_t(image.width) * image.height * 3);
  for (std::size_t pixel = 0; pixel < image.rgb.size() / 3; ++pixel)
    for (int c = 0; c < 3; ++c) image.rgb[pixel * 3 + c] = read.bytes[pixel * channels + (channels >= 3 ? c : 0)];
  return image;
}

void write_exr(const std::string& path, int width, int height, const std::vector<FloatChannel>& channels) {
  std::vector<std::string> names;
  std::vector<Span> planes;
  for (const auto& [name, values] : channels) {
    DENDRO_CHECK(values.size() == std::size_t(width) * height, "channel {}", name);
    names.push_back(name);
    planes.push_back({values.data(), values.size() * sizeof(float)});
  }
  write_file(path, picture_work({{"work", "encode floats"}, {"width", width}, {"height", height}, {"channels", names}}, path, planes).bytes);
}

std::vector<FloatChannel> read_exr(const std::string& path, int& width, int& height) {
  const PictureMessage read = picture_work({{"work", "read floats"}}, path);
  width = read.head["width"], height = read.head["height"];
  const std::size_t pixels = std::size_t(width) * height, count = read.head["channels"].size();
  std::vector<FloatChannel> channels;
  for (std::size_t c = 0; c < count; ++c) {
    channels.emplace_back(read.head["channels"][c], std::vector<float>(pixels));
    for (std::size_t i = 0; i < pixels; ++i)
      std::memcpy(&channels.back().second[i], read.bytes.data() + (i * count + c) * sizeof(float), sizeof(float));
  }
  return channels;
}

std::string image_digest(const RgbImage& image) {
  return base::sha256(std::string_view(reinterpret_cast<const char*>(image.rgb.data()), image.rgb.size()));
}

}  // namespace dendro::scene
