#include "sim/base/sha256.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <fstream>
#include <iterator>

#include "sim/base/check.h"
#include "sim/base/error.h"

namespace dendro::base {

std::string sha256(std::string_view bytes) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned length = 0;
  const int good = EVP_Digest(bytes.data(), bytes.size(), digest, &length, EVP_sha256(), nullptr);
  DENDRO_CHECK(good == 1, "EVP_Digest");
  std::string hex;
  for (unsigned i = 0; i < length; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

std::string sha256_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw UserError(path, 0, "", "cannot read the file");
  return sha256(std::string(std::istreambuf_iterator<char>(in), {}));
}

}  // namespace dendro::base
