#pragma once

#include <gtest/gtest.h>

#include <systemc>

/// The main function of a test program that elaborates SystemC: without its notes.
int main(int argc, char** argv) {
  sc_core::sc_report_handler::set_actions(sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
  ::testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
