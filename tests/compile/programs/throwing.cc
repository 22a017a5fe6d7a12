/* throwing.cc - C++ that leaves functions by exceptions, through clean-ups; guest() returns a checksum. */
#include "boxes.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace
{

struct shape {
    virtual ~shape() = default;
    virtual long area(long n) const = 0;
};
struct square : shape {
    long area(long n) const override { return n * n; }
};
struct oblong : shape {
    long area(long n) const override
    {
        if (n % 5 == 3) throw std::out_of_range("three");
        return 2 * n * n;
    }
};

long cleanups;
struct guard {
    long weight;
    ~guard() { cleanups += weight; }
};

__attribute__((noinline)) long risky(const shape &s, long n)
{
    guard g{n};
    std::string text(static_cast<std::size_t>(n), 'x');
    if (n % 7 == 6) throw text;
    return s.area(n) + static_cast<long>(text.size());
}

__attribute__((noinline)) long caught(const shape &s, long n)
{
    guard g{100};
    try {
        return risky(s, n);
    } catch (const std::exception &e) {
        return e.what()[0];
    } catch (const std::string &text) {
        if (n > 10) throw;
        return -static_cast<long>(text.size());
    }
}

} // namespace

extern "C" long guest()
{
    static const std::vector<long> steps(12, 3);
    const square a;
    const oblong b;
    long sum = 0;
    cleanups = 0;
    box<long>::made = 0;
    for (long n = 0; n < 12; n++) {
        try {
            sum = sum * 3 + caught(n % 2 ? static_cast<const shape &>(a) : b, n);
        } catch (const std::string &text) {
            sum += static_cast<long>(text.size());
        }
    }
    for (long s : steps) sum += s;
    return sum + cleanups + boxed(5) + other_boxes(6);
}
