#include "sim/scene/image_io.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "sim/base/error.h"
#include "sim/base/sha256.h"

namespace dendro::scene {
namespace {

std::string temporary(const std::string& name) { return testing::TempDir() + "dendro_image_io_" + name; }

RgbImage gradient(int width, int height) {
  RgbImage image{width, height, {}};
  for (int i = 0; i < width * height * 3; ++i) image.rgb.push_back(static_cast<std::uint8_t>(i * 7));
  return image;
}

TEST(Png, ComesBackBitForBit) {
  const std::string path = temporary("a.png");
  const RgbImage image = gradient(13, 5);
  write_png(path, image);
  const RgbImage back = read_rgb(path);
  EXPECT_EQ(back.width, 13);
  EXPECT_EQ(back.height, 5);
  EXPECT_EQ(back.rgb, image.rgb);
  std::filesystem::remove(path);
}

TEST(Exr, KeepsFloatsAndTheNamesOfItsLayers) {
  const std::string path = temporary("a.exr");
  const std::vector<FloatChannel> channels{
      {"R", {0, 0.1f, 1e-20f, 4}}, {"Z", {4095, -1, 2.5f, 3}}, {"cost.visits", {1, 2, 3, 4}}};
  write_exr(path, 2, 2, channels);
  int width = 0, height = 0;
  const std::vector<FloatChannel> back = read_exr(path, width, height);
  EXPECT_EQ(width, 2);
  EXPECT_EQ(height, 2);
  for (const FloatChannel& channel : channels) {
    bool found = false;
    for (const FloatChannel& other : back) {
      if (other.first != channel.first) continue;
      found = true;
      EXPECT_EQ(other.second, channel.second) << channel.first;
    }
    EXPECT_TRUE(found) << channel.first;
  }
  std::filesystem::remove(path);
}

TEST(Exr, HoldsNoTimeOfDay) {
  const std::string path = temporary("timeless.exr");
  write_exr(path, 1, 1, {{"R", {0.5f}}});
  std::ifstream in(path, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  ASSERT_FALSE(bytes.empty());
  EXPECT_FALSE(std::regex_search(bytes, std::regex("[0-9]{4}:[0-9]{2}:[0-9]{2}")));
  std::filesystem::remove(path);
}

TEST(Picture, ThatCannotBeWrittenIsAUserErrorAndLeavesNothing) {
  const std::string path = temporary("none") + "/deep/a.png";
  EXPECT_THROW(write_png(path, gradient(2, 2)), UserError);
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_THROW(write_exr(temporary("none") + "/deep/a.exr", 1, 1, {{"R", {0}}}), UserError);
}

TEST(Picture, ThatCannotBeReadIsAUserError) {
  EXPECT_THROW(read_rgb(temporary("missing.png")), UserError);
  const std::string path = temporary("noise.png");
  std::ofstream(path) << "not a picture";
  EXPECT_THROW(read_rgb(path), UserError);
  std::filesystem::remove(path);
}

TEST(Animation, HasAllPicturesInTheirOrderAndRunsForever) {
  std::vector<std::string> pictures;
  for (const int shade : {0, 120, 255}) {
    pictures.push_back(temporary("shade" + std::to_string(shade) + ".png"));
    write_png(pictures.back(), {8, 6, std::vector<std::uint8_t>(8 * 6 * 3, static_cast<std::uint8_t>(shade))});
  }
  const std::string path = temporary("a.gif");
  write_animation(path, pictures, 10);
  std::ifstream in(path, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(in), {});
  std::vector<int> delays;
  for (std::size_t at = bytes.find("\x21\xf9\x04"); at != std::string::npos; at = bytes.find("\x21\xf9\x04", at + 1))
    delays.push_back(static_cast<unsigned char>(bytes[at + 4]));
  EXPECT_EQ(delays, (std::vector<int>{10, 10, 10}));
  EXPECT_NE(bytes.find("NETSCAPE2.0"), std::string::npos);
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const RgbImage frame = read_frame(path, static_cast<int>(i)), wanted = read_rgb(pictures[i]);
    ASSERT_EQ(frame.rgb.size(), wanted.rgb.size());
    for (std::size_t k = 0; k < frame.rgb.size(); ++k) EXPECT_NEAR(frame.rgb[k], wanted.rgb[k], 8);
  }
  EXPECT_THROW(write_animation(temporary("none") + "/deep/a.gif", pictures, 10), UserError);
  for (const std::string& picture : pictures) std::filesystem::remove(picture);
  std::filesystem::remove(path);
}

TEST(ImageDigest, IsThatOfTheRgbBytes) {
  const RgbImage image{1, 1, {'a', 'b', 'c'}};
  EXPECT_EQ(image_digest(image), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace dendro::scene
