// Time of the digest of a bag of 64 MiB, read from the system's cache of files.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <string>

#include "evolin_ros/base/sha256.h"
#include "test/support/temporary_folder.h"

namespace {

void digestOfFile(benchmark::State& state) {
  constexpr std::size_t kBytes = std::size_t{64} << 20U;
  const evolin::test::TemporaryFolder folder;
  const auto file = folder.write("bag", std::string(kBytes, 'x'));
  for (auto _ : state) {
    benchmark::DoNotOptimize(evolin::sha256OfFile(file));
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(kBytes));
}
BENCHMARK(digestOfFile)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
