// Runs trials on a simulated core as fast as the simulator goes; `softdepth.sim.trials` writes them and reads
// what is said. Arguments: the trials' file, then the values of the input `mutant`, where the design has it.

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "Vtop.h"
#include "verilated.h"
#if VM_COVERAGE
#include "verilated_cov.h"
#endif

namespace {

struct Due {
    uint64_t bits, mask;
};

struct Trial {
    uint64_t seed, i_pause, o_pause;       // pauses in 1024 clocks
    uint64_t reset, cut, patience, settle; // clocks; cut 0: to the end
    uint64_t exact, limit;                 // whether no more may come; clocks that it may take, 0: any number
    uint64_t status, status_known;
    std::vector<uint64_t> sent;
    std::vector<Due> due;
};

struct Random {
    uint64_t state;
    uint64_t next() {  // xorshift64*
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        return state * 0x2545F4914F6CDD1DULL;
    }
    bool in_1024(uint64_t share) { return ((next() >> 32) & 1023) < share; }
};

std::vector<Trial> read(const char* path) {
    std::ifstream file(path);
    std::vector<Trial> trials;
    uint64_t sent, due;
    for (Trial t; file >> t.seed >> t.i_pause >> t.o_pause >> t.reset >> t.cut >> t.patience >> t.settle >>
                  t.exact >> t.limit >> t.status >> t.status_known >> sent >> due;) {
        t.sent.resize(sent);
        t.due.resize(due);
        for (auto& word : t.sent) file >> word;
        for (auto& each : t.due) file >> each.bits >> each.mask;
        trials.push_back(t);
    }
    return trials;
}

class Bench {
  public:
    explicit Bench(uint64_t mutant) : top(new Vtop(&context)) {
#ifdef MUTANTS
        top->mutant = mutant;
#else
        (void)mutant;
#endif
        context.randReset(2);
        context.randSeed(1);
    }

    ~Bench() { top->final(); }

    // What went wrong in a trial, or nothing.
    std::string run(const Trial& t) {
        Random random{t.seed * 2 + 1};
        for (uint64_t clock = 0; clock < t.reset; clock++) {
            show(random.next(), true, random.next() & 1, true);
            if (top->i_ready) return "a pixel is taken in reset";
            edge();
        }
        size_t taken = 0, given = 0;
        bool offered = false, waiting = false;
        uint64_t held = 0, quiet = 0, last = 0;
        for (uint64_t clock = 0; !t.cut || clock < t.cut; clock++) {
            offered = taken < t.sent.size() && (offered || !random.in_1024(t.i_pause));
            // A sink may wait for an offer before it is ready: an offer that waits for it never comes.
            const bool ready = t.o_pause <= 1024 ? !random.in_1024(t.o_pause) : waiting;
            show(offered ? t.sent[taken] : random.next(), offered, ready, false);
            const bool valid = top->o_valid;
            const uint64_t payload = top->o_payload;
            if (waiting && !valid) return "an offer is withdrawn";
            if (waiting && payload != held) return "an offer is altered";
            waiting = valid && !ready;
            held = payload;
            quiet++;
            if (offered && top->i_ready) {
                taken++;
                offered = false;
                quiet = 0;
            }
            if (valid && ready) {
                quiet = 0;
                last = clock;
                if (given < t.due.size()) {
                    if ((payload ^ t.due[given].bits) & t.due[given].mask)
                        return "result " + std::to_string(given) + " is wrong";
                } else if (t.exact) {
                    return "there are too many results";
                }
                given++;
            }
            edge();
            clocks++;
            const bool complete = taken == t.sent.size() && given >= t.due.size();
            if (quiet > (complete ? t.settle : t.patience)) {
                if (!complete) return "it stops";
                if (t.limit && last > t.limit) return "it takes " + std::to_string(last) + " clocks";
                if (t.status_known && top->status != t.status) return "a counter is wrong";
                return "";
            }
        }
        return "";
    }

    void cover(const char* path) {
#if VM_COVERAGE
        context.coveragep()->write(path);
#else
        (void)path;
#endif
    }

    uint64_t clocks = 0;

  private:
    VerilatedContext context;
    std::unique_ptr<Vtop> top;

    void show(uint64_t payload, bool valid, bool ready, bool reset) {
        top->clk = 0;
        top->rst = reset;
        top->i_valid = valid;
        top->i_payload = payload & I_MASK;
        top->o_ready = ready;
        top->eval();
    }

    void edge() {
        top->clk = 1;
        top->eval();
    }
};

}  // namespace

int main(int count, char** words) {
    const auto trials = read(words[1]);
    std::vector<uint64_t> mutants{0};
    if (count > 2) mutants.clear();
    for (int k = 2; k < count; k++) mutants.push_back(std::strtoull(words[k], nullptr, 10));
    for (const auto mutant : mutants) {
        Bench bench(mutant);
        std::string wrong;
        size_t number = 0;
        for (; number < trials.size() && wrong.empty(); number++) wrong = bench.run(trials[number]);
        std::printf("%llu %zu %llu %s\n", (unsigned long long)mutant, number, (unsigned long long)bench.clocks,
                    wrong.c_str());
        std::fflush(stdout);
        if (const char* path = std::getenv("SOFTDEPTH_COVERAGE")) bench.cover(path);
    }
    return 0;
}
