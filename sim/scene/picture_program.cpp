// dendro-pictures: reads and writes picture files for the process at the other end of its standard input. A process of its own, as the
// library's 260 shared libraries take more memory than most simulated machines.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <cstdio>
#include <memory>

#include "sim/base/error.h"
#include "sim/scene/picture_messages.h"

namespace dendro::scene {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

std::string text(const Json& json) { return json.get<std::string>(); }

void must(bool good, const std::string& what) {
  if (!good) throw std::logic_error(what);
}

std::unique_ptr<OIIO::ImageInput> open_image(const std::string& path) {
  std::unique_ptr<OIIO::ImageInput> in = OIIO::ImageInput::open(path);
  if (!in) throw UserError(path, 0, {}, "is not a readable picture: " + OIIO::geterror());
  return in;
}

/// Pixels of subimage `number`, channels of a pixel together.
PictureMessage read_pixels(const std::string& path, int number, OIIO::TypeDesc type) {
  const std::unique_ptr<OIIO::ImageInput> in = open_image(path);
  if (!in->seek_subimage(number, 0)) throw UserError(path, 0, {}, "has no picture " + std::to_string(number));
  const OIIO::ImageSpec spec = in->spec();
  PictureMessage answer;
  answer.head = {{"width", spec.width}, {"height", spec.height}, {"channels", spec.channelnames}};
  answer.bytes.resize(std::size_t(spec.width) * spec.height * spec.nchannels * type.size());
  if (!in->read_image(number, 0, 0, spec.nchannels, type, answer.bytes.data()))
    throw UserError(path, 0, {}, "cannot be read: " + in->geterror());
  return answer;
}

Bytes file_bytes(const std::string& path, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, const void* pixels) {
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(path);
  if (!out) throw UserError(path, 0, {}, "is not a picture format that can be written");
  // By way of memory: the library's PNG writer does not notice when the disk is full.
  OIIO::Filesystem::IOVecOutput bytes;
  must(out->supports("ioproxy") && out->set_ioproxy(&bytes), path);
  const bool good = out->open(path, spec) && out->write_image(type, pixels) && out->close();
  must(good, path + ": " + out->geterror());
  return bytes.buffer();
}

Bytes rgb_file(const Json& head, const Bytes& rgb) {
  return file_bytes(head["path"], OIIO::ImageSpec(head["width"], head["height"], 3, OIIO::TypeDesc::UINT8), OIIO::TypeDesc::UINT8, rgb.data());
}

/// `planes` holds one channel of floats after the other.
Bytes float_file(const Json& head, const Bytes& planes) {
  const int count = static_cast<int>(head["channels"].size());
  OIIO::ImageSpec spec(head["width"], head["height"], count, OIIO::TypeDesc::FLOAT);
  spec.channelnames = head["channels"].get<std::vector<std::string>>();
  spec.attribute("compression", "zip");
  // Without one the writer puts the time of day into the file, and no two runs would be alike.
  spec.attribute("DateTime", "");
  const std::size_t pixels = std::size_t(spec.width) * spec.height;
  const float* plane = reinterpret_cast<const float*>(planes.data());
  std::vector<float> interleaved(pixels * count);
  for (int c = 0; c < count; ++c, plane += pixels)
    for (std::size_t i = 0; i < pixels; ++i) interleaved[i * count + c] = plane[i];
  return file_bytes(head["path"], spec, OIIO::TypeDesc::FLOAT, interleaved.data());
}

void write_animation(const Json& head) {
  const std::string path = head["path"];
  const std::unique_ptr<OIIO::ImageOutput> out = OIIO::ImageOutput::create(path);
  must(out && out->supports("multiimage"), path + ": " + OIIO::geterror());
  const int rate[] = {static_cast<int>(head["pictures_a_second"].get<double>() * 100), 100};
  OIIO::ImageSpec spec;
  bool good = true;
  for (const Json& picture : head["pictures"]) {
    if (!good) break;
    const bool first = spec.undefined();
    const PictureMessage read = read_pixels(picture, 0, OIIO::TypeDesc::UINT8);
    const OIIO::ImageSpec its(read.head["width"], read.head["height"], 3, OIIO::TypeDesc::UINT8);
    must(read.head["channels"].size() == 3 && (first || (its.width == spec.width && its.height == spec.height)), text(picture));
    if (first) {
      spec = its;
      spec.attribute("FramesPerSecond", OIIO::TypeDesc(OIIO::TypeDesc::INT, OIIO::TypeDesc::VEC2, OIIO::TypeDesc::RATIONAL), rate);
      spec.attribute("oiio:Movie", 1);
    }
    good = out->open(path, spec, first ? OIIO::ImageOutput::Create : OIIO::ImageOutput::AppendSubimage) &&
           out->write_image(OIIO::TypeDesc::UINT8, read.bytes.data());
  }
  if (out->close() && good) return;
  std::remove(path.c_str());
  throw UserError(path, 0, {}, "cannot be written: " + out->geterror());
}

PictureMessage answer_to(const PictureMessage& request) {
  const Json& head = request.head;
  const std::string work = head["work"];
  if (work == "read rgb") return read_pixels(head["path"], head["number"], OIIO::TypeDesc::UINT8);
  if (work == "read floats") return read_pixels(head["path"], 0, OIIO::TypeDesc::FLOAT);
  if (work == "encode rgb") return {Json::object(), rgb_file(head, request.bytes)};
  if (work == "encode floats") return {Json::object(), float_file(head, request.bytes)};
  must(work == "write animation", work);
  write_animation(head);
  return {Json::object(), {}};
}

PictureMessage outcome_of(const PictureMessage& request) {
  try {
    return answer_to(request);
  } catch (const UserError& e) {
    return {{{"error", {{"file", e.file()}, {"message", e.message()}}}}, {}};
  } catch (const std::exception& e) {
    return {{{"bug", e.what()}}, {}};
  }
}

}  // namespace
}  // namespace dendro::scene

int main() {
  dendro::scene::PictureMessage request;
  while (dendro::scene::receive_message(STDIN_FILENO, request)) {
    const dendro::scene::PictureMessage answer = dendro::scene::outcome_of(request);
    if (!dendro::scene::send_message(STDIN_FILENO, answer.head, {{answer.bytes.data(), answer.bytes.size()}})) break;
  }
  // At once: the destructors of so many libraries have nothing to do that the end of the process does not.
  ::_exit(0);
}
