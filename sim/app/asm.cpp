#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "firmware/tools/assembler.h"
#include "firmware/tools/disassembler.h"
#include "firmware/tools/igc_assembler.h"
#include "firmware/tools/igc_disassembler.h"
#include "firmware/tools/ucode.h"
#include "sim/app/arguments.h"
#include "sim/app/commands.h"
#include "sim/base/error.h"
#include "sim/config/document.h"
#include "sim/study/algorithms.h"
#include "sim/study/run_folder.h"

namespace dendro::app {
namespace {

struct Options {
  std::string machine, in, out, listing;
  tools::AssembleOptions assemble;
};

constexpr const char* kPixelPlanes = "pixel-planes";

bool is_pixel_planes(const std::string& machine) { return machine.substr(0, machine.find(':')) == kPixelPlanes; }

void check_machine(const std::string& machine, const study::Catalogue& catalogue) {
  const std::string name = machine.substr(0, machine.find(':'));
  if ((name != "rds3000" && name != kPixelPlanes) || catalogue.machine(name) == nullptr)
    throw UserError("", 0, machine, "there are microassemblers for rds3000 and pixel-planes only");
}

int assemble(const Options& options) {
  refuse_same_file("--out", options.out, "the source", options.in);
  refuse_same_file("--listing", options.listing, "the source", options.in);
  refuse_same_file("--listing", options.listing, "--out", options.out);
  study::OutputFile out(options.out), listing(options.listing);
  if (is_pixel_planes(options.machine)) {
    if (!options.listing.empty()) throw UserError("--listing", 0, "", "there are listings of rds3000 programs only");
    const tools::IgcImage image = tools::assemble_igc(config::read_text({false, options.in}, {}), options.in, {2, 256, {}});
    out.commit(tools::write_ucode(tools::igc_ucode(image)));
    return kGood;
  }
  tools::AssembleOptions settings = options.assemble;
  settings.include = study::include_beside(options.in);
  const tools::Assembly assembly =
      tools::assemble(config::read_text({false, options.in}, {}), options.in, settings);
  out.commit(tools::write_ucode(assembly.ucode));
  if (!options.listing.empty()) listing.commit(tools::listing(assembly));
  return kGood;
}

int disassemble(const Options& options) {
  refuse_same_file("--out", options.out, "the program", options.in);
  study::OutputFile out(options.out.empty() ? "-" : options.out);
  const tools::Ucode ucode = tools::read_ucode(config::read_text({false, options.in}, {}), options.in);
  const bool planes = is_pixel_planes(options.machine);
  if (planes != (ucode.machine == kPixelPlanes))
    throw UserError(options.in, 0, "", "the program is for " + ucode.machine);
  out.commit(planes ? tools::disassemble_igc(ucode) : tools::disassemble(ucode));
  return kGood;
}

}  // namespace

void add_asm(CLI::App& app, const study::Catalogue& catalogue, Action& action) {
  const auto o = std::make_shared<Options>();
  CLI::App* assembler = app.add_subcommand("asm", "assemble a microprogram");
  assembler->add_option("machine", o->machine, "rds3000 or pixel-planes")->required();
  assembler->add_option("in", o->in, "source, .gia or .igc")->required();
  assembler->add_option("-o,--out", o->out, ".ucode file; - is standard output")
      ->required()
      ->check(some_text());
  assembler->add_option("--pack", o->assemble.pack, "none: a line is a word; full: words are merged")
      ->check(CLI::IsMember({"none", "full"}));
  assembler->add_option("--multiply-ticks", o->assemble.multiply_ticks, "latency of the multiplier")
      ->check(whole_number(1, 64));
  assembler->add_flag("--fill-products", o->assemble.fill_products,
                      "insert words without effect where a product would be taken too early");
  assembler
      ->add_option("--listing", o->listing, "listing with addresses, words and ticks; - is standard output")
      ->check(some_text());
  assembler->callback([&, o] {
    action = [&catalogue, o] {
      check_machine(o->machine, catalogue);
      return assemble(*o);
    };
  });
  CLI::App* disassembler = app.add_subcommand("disasm", "turn a .ucode file back into a source");
  disassembler->add_option("machine", o->machine, "rds3000 or pixel-planes")->required();
  disassembler->add_option("in", o->in, ".ucode file")->required();
  disassembler->add_option("-o,--out", o->out, "source; default: standard output")->check(some_text());
  disassembler->callback([&, o] {
    action = [&catalogue, o] {
      check_machine(o->machine, catalogue);
      return disassemble(*o);
    };
  });
}

}  // namespace dendro::app
