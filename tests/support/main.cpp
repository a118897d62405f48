// The entry of every test program: Catch itself, compiled once.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
