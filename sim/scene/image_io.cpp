#include "sim/scene/image_io.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cstdio>
#include <fstream>
#include <memory>
#include <string_view>

#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/base/sha256.h"

namespace dendro::scene {
namespace {

void write_image(const std::string& path, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                 const void* pixels) {
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(path);
  if (!out) {
    OIIO::geterror();  // an error nobody fetches is printed at exit
    throw UserError(path, 0, {}, "is not a picture format that can be written");
  }
  // By way of memory: the library's PNG writer does not notice when the disk is full.
  OIIO::Filesystem::IOVecOutput bytes;
  DENDRO_CHECK(out->supports("ioproxy") && out->set_ioproxy(&bytes), "{}", path);
  const bool good = out->open(path, spec) && out->write_image(type, pixels) && out->close();
  DENDRO_CHECK(good, "{}: {}", path, out->geterror());
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(reinterpret_cast<const char*>(bytes.buffer().data()), static_cast<std::streamsize>(bytes.buffer().size()));
  file.close();
  if (file) return;
  std::remove(path.c_str());
  throw UserError(path, 0, {}, "cannot write here: the disk is full or the folder is missing or read-only");
}

std::unique_ptr<OIIO::ImageInput> open_image(const std::string& path) {
  std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open(path);
  if (!in) throw UserError(path, 0, {}, "is not a readable picture: " + OIIO::geterror());
  return in;
}

}  // namespace

void write_png(const std::string& path, const RgbImage& image) {
  DENDRO_CHECK(image.rgb.size() == std::size_t(image.width) * image.height * 3);
  write_image(path, OIIO::ImageSpec(image.width, image.height, 3, OIIO::TypeDesc::UINT8),
              OIIO::TypeDesc::UINT8, image.rgb.data());
}

void write_animation(const std::string& path, const std::vector<std::string>& pictures, double pictures_a_second) {
  DENDRO_CHECK(!pictures.empty());
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(path);
  DENDRO_CHECK(out && out->supports("multiimage"), "{}: {}", path, OIIO::geterror());
  const RgbImage first = read_rgb(pictures.front());
  OIIO::ImageSpec spec(first.width, first.height, 3, OIIO::TypeDesc::UINT8);
  const int rate[] = {static_cast<int>(pictures_a_second * 100), 100};
  spec.attribute("FramesPerSecond", OIIO::TypeDesc(OIIO::TypeDesc::INT, OIIO::TypeDesc::VEC2, OIIO::TypeDesc::RATIONAL), rate);
  spec.attribute("oiio:Movie", 1);
  bool good = true;
  for (std::size_t i = 0; i < pictures.size() && good; ++i) {
    const RgbImage image = i == 0 ? first : read_rgb(pictures[i]);
    DENDRO_CHECK(image.width == first.width && image.height == first.height, "{}", pictures[i]);
    good = out->open(path, spec, i == 0 ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage) &&
           out->write_image(OIIO::TypeDesc::UINT8, image.rgb.data());
  }
  if (out->close() && good) return;
  std::remove(path.c_str());
  throw UserError(path, 0, {}, "cannot be written: " + out->geterror());
}

RgbImage read_rgb(const std::string& path) { return read_frame(path, 0); }

RgbImage read_frame(const std::string& path, int number) {
  const std::unique_ptr<OIIO::ImageInput> in = open_image(path);
  if (!in->seek_subimage(number, 0)) throw UserError(path, 0, {}, "has no picture " + std::to_string(number));
  const OIIO::ImageSpec spec = in->spec();
  const int channels = spec.nchannels;
  std::vector<std::uint8_t> raw(std::size_t(spec.width) * spec.height * channels);
  if (!in->read_image(number, 0, 0, channels, OIIO::TypeDesc::UINT8, raw.data()))
    throw UserError(path, 0, {}, "cannot be read: " + in->geterror());
  RgbImage image{spec.width, spec.height,
                 std::vector<std::uint8_t>(std::size_t(spec.width) * spec.height * 3)};
  for (std::size_t pixel = 0; pixel < image.rgb.size() / 3; ++pixel)
    for (int c = 0; c < 3; ++c) image.rgb[pixel * 3 + c] = raw[pixel * channels + (channels >= 3 ? c : 0)];
  return image;
}

void write_exr(const std::string& path, int width, int height, const std::vector<FloatChannel>& channels) {
  const std::size_t pixels = std::size_t(width) * height;
  const int count = static_cast<int>(channels.size());
  OIIO::ImageSpec spec(width, height, count, OIIO::TypeDesc::FLOAT);
  spec.channelnames.clear();
  std::vector<float> interleaved(pixels * count);
  for (int c = 0; c < count; ++c) {
    DENDRO_CHECK(channels[c].second.size() == pixels, "channel {}", channels[c].first);
    spec.channelnames.push_back(channels[c].first);
    for (std::size_t i = 0; i < pixels; ++i) interleaved[i * count + c] = channels[c].second[i];
  }
  spec.attribute("compression", "zip");
  // Without one the writer puts the time of day into the file, and no two runs would be alike.
  spec.attribute("DateTime", "");
  write_image(path, spec, OIIO::TypeDesc::FLOAT, interleaved.data());
}

std::vector<FloatChannel> read_exr(const std::string& path, int& width, int& height) {
  const std::unique_ptr<OIIO::ImageInput> in = open_image(path);
  const OIIO::ImageSpec spec = in->spec();
  width = spec.width, height = spec.height;
  const std::size_t pixels = std::size_t(width) * height;
  std::vector<float> raw(pixels * spec.nchannels);
  if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, raw.data()))
    throw UserError(path, 0, {}, "cannot be read: " + in->geterror());
  std::vector<FloatChannel> channels;
  for (int c = 0; c < spec.nchannels; ++c) {
    channels.emplace_back(spec.channelnames[c], std::vector<float>(pixels));
    for (std::size_t i = 0; i < pixels; ++i) channels.back().second[i] = raw[i * spec.nchannels + c];
  }
  return channels;
}

std::string image_digest(const RgbImage& image) {
  return base::sha256(std::string_view(reinterpret_cast<const char*>(image.rgb.data()), image.rgb.size()));
}

}  // namespace dendro::scene
