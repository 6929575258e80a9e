#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace dendro::scene {

/// 8-bit RGB, rows top down.
struct RgbImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;  ///< width * height * 3
};

/// One channel of floats by its EXR name ("R", "Z", "cost.visits"), width * height values, rows top down.
using FloatChannel = std::pair<std::string, std::vector<float>>;

/// Throws UserError when pictures can be neither read nor written, because the program that does it is not installed: said before long
/// work instead of after it.
void require_picture_files();

/// Writes an 8-bit PNG. Throws UserError when the file cannot be written; then nothing is left of it.
void write_png(const std::string& path, const RgbImage& image);

/// Joins RGB picture files of one size to a GIF that runs forever. Throws UserError when it cannot be written; then nothing is left
/// of it.
void write_animation(const std::string& path, const std::vector<std::string>& pictures, double pictures_a_second);

/// Reads the first three channels of a picture file as 8-bit RGB; one channel becomes grey. Throws UserError.
RgbImage read_rgb(const std::string& path);

/// The same of picture `number`, from 0, of an animation.
RgbImage read_frame(const std::string& path, int number);

/// Writes a 32-bit float EXR with the channels in the given order. Throws UserError; then nothing is left of
/// it.
void write_exr(const std::string& path, int width, int height, const std::vector<FloatChannel>& channels);

/// Reads all channels of a float picture with their names. Throws UserError.
std::vector<FloatChannel> read_exr(const std::string& path, int& width, int& height);

/// SHA-256 of the RGB bytes, rows top down, as hex.
std::string image_digest(const RgbImage& image);

}  // namespace dendro::scene
