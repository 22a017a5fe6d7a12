/* units.c - quantities with units, read and written without a rounding too many.
 *
 * A unit is a symbol with an optional prefix. Its factor is kept as 10^e10 2^e2 times a rest that
 * is 1 for all but degrees and atomic masses: the power of ten joins the decimal exponent of the
 * number's text before the one rounding to binary, and the power of two is exact. So "60 ns" is the
 * double nearest to 6e-8, which 60 * 1e-9 is not, and the printer, which only moves the decimal
 * point, always reads back. */
#include "base/units.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/check.h"
#include "base/text.h"

enum { UP = 1, DOWN = 2, BINARY = 4 }; /* prefixes that a symbol takes */

/* Powers of ten join the number's decimal exponent, powers of two are exact factors. */
static const struct prefix {
    const char *name;
    int kind, e10, e2;
} PREFIXES[] = {
    {"", UP | DOWN | BINARY, 0, 0}, {"k", UP, 3, 0},        {"M", UP, 6, 0},         {"G", UP, 9,
     0},
    {"T", UP, 12, 0},               {"P", UP, 15, 0},       {"m", DOWN, -3, 0},      {"u", DOWN, -6,
     0},
    {"n", DOWN, -9, 0},             {"p", DOWN, -12, 0},    {"f", DOWN, -15, 0},     {"Ki", BINARY,
     0, 10},
    {"Mi", BINARY, 0, 20},          {"Gi", BINARY, 0, 30},  {"Ti", BINARY, 0, 40},
};
enum { NPREFIX = sizeof PREFIXES / sizeof PREFIXES[0], NSYMBOL = 10, NAME_SIZE = 24 };

/* One symbol: its prefixes, and its factor to the SI unit: rest 10^e10 2^e2 (rest 0 stands for
 * 1). */
struct symbol {
    const char *name;
    int prefixes, e10, e2;
    double rest;
};

static const double DEGREE = 0.017453292519943295; /* pi / 180 */

/* One kind: how messages call it, an example, its SI symbol for SQL, the symbols that may be
 * written (the first is the one printed), and the decimal exponents between which the printer
 * chooses prefixes. */
static const struct kind {
    const char *name, *example, *si;
    struct symbol symbol[NSYMBOL];
    int print_min, print_max;
} KINDS[UNIT_KINDS] = {
    [UNIT_NONE] = {"a bare number", "3", "", {{0}}, 0, 0},
    [UNIT_TIME] = {"a time", "12 us", "s", {{"s", DOWN, 0, 0, 0}}, -12, 0},
    [UNIT_BYTES] = {"a size",
                    "64 KiB",
                    "B",
                    {{"B", UP | BINARY, 0, 0, 0},
                     {"bit", UP | BINARY, 0, -3, 0},
                     {"b", UP | BINARY, 0, -3, 0}},
                    0,
                    15},
    [UNIT_BANDWIDTH] = {"a bandwidth",
                        "480 MB/s",
                        "B_per_s",
                        {{"B/s", UP | BINARY, 0, 0, 0},
                         {"bit/s", UP | BINARY, 0, -3, 0},
                         {"b/s", UP | BINARY, 0, -3, 0}},
                        0,
                        15},
    [UNIT_TIME_PER_BYTE] = {"a time per byte",
                            "3.2 ns/B",
                            "s_per_B",
                            {{"s/B", DOWN, 0, 0, 0},
                             {"s/kB", DOWN, -3, 0, 0},
                             {"s/MB", DOWN, -6, 0, 0},
                             {"s/GB", DOWN, -9, 0, 0},
                             {"s/KiB", DOWN, 0, -10, 0},
                             {"s/MiB", DOWN, 0, -20, 0},
                             {"s/bit", DOWN, 0, 3, 0},
                             {"s/b", DOWN, 0, 3, 0}},
                            -12,
                            0},
    [UNIT_FREQUENCY] = {"a frequency", "300 MHz", "Hz", {{"Hz", UP, 0, 0, 0}}, 0, 12},
    [UNIT_FLOP_RATE] =
        {"a floating-point rate", "50 Mflop/s", "flop_per_s", {{"flop/s", UP, 0, 0, 0}}, 0, 15},
    [UNIT_CYCLES] = {"a number of cycles",
                     "31 cycles",
                     "cycles",
                     {{"cycles", 0, 0, 0, 0}, {"cycle", 0, 0, 0, 0}},
                     0,
                     0},
    [UNIT_LENGTH] =
        {"a length", "0.5 m", "m", {{"m", UP | DOWN, 0, 0, 0}, {"angstrom", 0, -10, 0, 0}}, -12, 3},
    [UNIT_MASS] = {"a mass",
                   "1.5 kg",
                   "kg",
                   {{"kg", 0, 0, 0, 0}, {"g", DOWN, -3, 0, 0}, {"amu", 0, -27, 0, 1.66053906660}},
                   0,
                   0},
    [UNIT_ANGLE] =
        {"an angle", "30 deg", "rad", {{"rad", DOWN, 0, 0, 0}, {"deg", 0, 0, 0, DEGREE}}, -3, 0},
    [UNIT_ANGULAR_RATE] = {"an angular rate",
                           "0.2 rad/s",
                           "rad_per_s",
                           {{"rad/s", DOWN, 0, 0, 0}, {"deg/s", 0, 0, 0, DEGREE}},
                           -3,
                           0},
    [UNIT_ACCELERATION] =
        {"an acceleration", "9.81 m/s^2", "m_per_s2", {{"m/s^2", DOWN, 0, 0, 0}}, 0, 0},
    [UNIT_PERCENT] = {"a percentage", "5 %", "fraction", {{"%", 0, -2, 0, 0}}, -2, -2},
    [UNIT_STIFFNESS] = {"a rotational stiffness",
                        "100 N m/rad",
                        "Nm_per_rad",
                        {{"N m/rad", UP | DOWN, 0, 0, 0}, {"Nm/rad", UP | DOWN, 0, 0, 0}},
                        0,
                        6},
    [UNIT_DAMPING] = {"a rotational damping",
                      "2 N m s/rad",
                      "Nms_per_rad",
                      {{"N m s/rad", UP | DOWN, 0, 0, 0}, {"Nms/rad", UP | DOWN, 0, 0, 0}},
                      0,
                      6},
    [UNIT_TORQUE] = {"a torque",
                     "4 N m",
                     "Nm",
                     {{"N m", UP | DOWN, 0, 0, 0}, {"Nm", UP | DOWN, 0, 0, 0}},
                     0,
                     6},
    [UNIT_FORCE] = {"a force", "10 N", "N", {{"N", UP | DOWN, 0, 0, 0}}, 0, 6},
    [UNIT_ANGULAR_ACCELERATION] =
        {"an angular acceleration", "2 rad/s^2", "rad_per_s2", {{"rad/s^2", DOWN, 0, 0, 0}}, 0, 0},
};

static const struct kind *kind_of(enum unit unit)
{
    CHECK((unsigned)unit < UNIT_KINDS);
    return &KINDS[unit];
}

/* What messages, examples and SQL call a kind. */
const char *units_name(enum unit unit)
{
    return kind_of(unit)->name;
}

const char *units_example(enum unit unit)
{
    return kind_of(unit)->example;
}

const char *units_si(enum unit unit)
{
    return kind_of(unit)->si;
}

/* --- reading ---------------------------------------------------------------------------------- */

/* prefix_fits: "" fits every symbol, another prefix those that name its kind. */
static bool prefix_fits(const struct prefix *p, const struct symbol *s)
{
    return p->name[0] == '\0' || (p->kind & s->prefixes) != 0;
}

/* unit_find: the prefix and symbol of kind k that together spell `name`. */
static bool unit_find(const struct kind *k, const char *name, const struct prefix **prefix,
                      const struct symbol **symbol)
{
    /* "m" is also a prefix: every split of the name into prefix and symbol is tried, within one
     * kind, where none is ambiguous. */
    for (const struct symbol *s = k->symbol; s < k->symbol + NSYMBOL && s->name; s++) {
        for (const struct prefix *p = PREFIXES; p < PREFIXES + NPREFIX; p++) {
            size_t n = strlen(p->name);
            if (!prefix_fits(p, s) || strncmp(name, p->name, n) != 0 ||
                strcmp(name + n, s->name) != 0)
                continue;
            *prefix = p;
            *symbol = s;
            return true;
        }
    }
    return false;
}

/* unit_spelling: one spelling for the ways people write the same unit: one space between words, `*`
 * and the middle dot as a space, the Greek mu as u, the degree sign, the angstrom sign and the
 * superscript two in letters. */
static void unit_spelling(const char *text, char *name, size_t size)
{
    static const char *const same[][2] = {
        {"\u00b5", "u"},        {"\u03bc", "u"},  {"\u00b0", "deg"}, {"\u00c5", "angstrom"},
        {"\u212b", "angstrom"}, {"\u00b2", "^2"}, {"\u00b7", " "},   {"*", " "}};
    size_t n = 0;
    name[0] = '\0';
    while (*text && n + 1 < size) {
        char letter[2] = {isspace((unsigned char)*text) ? ' ' : *text, '\0'};
        const char *next = letter;
        size_t eaten = 1;
        /* One of the listed signs, or the letter itself; all but the last lie beyond ASCII. */
        const bool plain = (unsigned char)*text < 0x80 && *text != '*';
        for (size_t i = 0; !plain && i < sizeof same / sizeof same[0]; i++) {
            if (strncmp(text, same[i][0], strlen(same[i][0])) != 0) continue;
            next = same[i][1];
            eaten = strlen(same[i][0]);
        }
        text += eaten;
        /* Blanks: none at the beginning, never two. */
        if (next[0] == ' ' && (n == 0 || name[n - 1] == ' ')) continue;
        text_copy(name + n, size - n, next);
        n += strlen(name + n);
    }
    if (n > 0 && name[n - 1] == ' ') name[n - 1] = '\0';
}

/* number_span: length of a decimal number at s ([+-] digits [. digits] [e [+-] digits]), 0 when
 * there is none; the mantissa's length goes to *mantissa. So "inf", "nan" and hexadecimal numbers
 * are none. */
static size_t number_span(const char *s, size_t *mantissa)
{
    size_t i = s[0] == '+' || s[0] == '-', digits = 0;
    for (; isdigit((unsigned char)s[i]); i++) digits++;
    if (s[i] == '.')
        for (i++; isdigit((unsigned char)s[i]); i++) digits++;
    *mantissa = i;
    if (digits == 0) return 0;
    if (s[i] != 'e' && s[i] != 'E') return i;
    /* "1 e" is a number and a unit that begins with e. */
    size_t j = i + 1 + (s[i + 1] == '+' || s[i + 1] == '-');
    if (!isdigit((unsigned char)s[j])) return i;
    while (isdigit((unsigned char)s[j])) j++;
    return j;
}

enum { NUMBER_MAX = 400 }; /* characters of a mantissa; nobody writes more on purpose */

/* Powers of ten that are doubles. */
enum { EXACT_POWERS = 22, EXACT_DIGITS = 15 };
static const double power[EXACT_POWERS + 1] = {
    1,    1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
    1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

/* few_digits: the mantissa of n characters at s times 10^exponent into *x, where its digits and the
 * power are doubles, so that one operation rounds as strtod does (Clinger, PLDI 1990); false: they
 * are not. */
static bool few_digits(const char *s, size_t n, long exponent, double *x)
{
    int64_t m = 0;
    int digits = 0;
    bool point = false;
    for (size_t i = s[0] == '+' || s[0] == '-'; i < n; i++) {
        if (s[i] == '.') {
            point = true;
            continue;
        }
        if (++digits > EXACT_DIGITS) return false;
        m = m * 10 + (s[i] - '0');
        exponent -= point;
    }
    if (exponent < -EXACT_POWERS || exponent > EXACT_POWERS) return false;
    *x = exponent < 0 ? (double)m / power[-exponent] : (double)m * power[exponent];
    if (s[0] == '-') *x = -*x;
    return true;
}

/* scaled: the number of `span` characters at s, times 10^e10, rounded once: the exponents are added
 * in the text, before strtod makes a double of it. */
static double scaled(const char *s, size_t mantissa, size_t span, int e10)
{
    char joined[NUMBER_MAX + 32];
    long exponent = span > mantissa ? strtol(s + mantissa + 1, NULL, 10) : 0;
    /* Far outside the range of doubles: cut off before the sum could overflow. */
    if (exponent > 100000) exponent = 100000;
    if (exponent < -100000) exponent = -100000;
    double x;
    if (few_digits(s, mantissa, exponent + e10, &x)) return x;
    snprintf(joined, sizeof joined, "%.*se%ld", (int)mantissa, s, exponent + e10);
    return strtod(joined, NULL);
}

/* unit_suggest: the unit of kind k whose name differs from `name` by letter case alone, or else the
 * nearest. */
static bool unit_suggest(const struct kind *k, const char *name, char *suggestion)
{
    /* All names of the kind; a few dozen. */
    char text[NSYMBOL * NPREFIX][NAME_SIZE];
    const char *names[NSYMBOL * NPREFIX];
    int n = 0;
    for (const struct symbol *s = k->symbol; s < k->symbol + NSYMBOL && s->name; s++) {
        for (const struct prefix *p = PREFIXES; p < PREFIXES + NPREFIX; p++) {
            if (!prefix_fits(p, s)) continue;
            snprintf(text[n], NAME_SIZE, "%s%s", p->name, s->name);
            names[n] = text[n];
            n++;
        }
    }
    const char *nearest = text_nearest(name, names, n);
    if (nearest) text_copy(suggestion, NAME_SIZE, nearest);
    return nearest != NULL;
}

/* unit_wrong: what is wrong with a unit that kind `unit` does not have. Returns false. */
static bool unit_wrong(enum unit unit, const char *name, char *why, int size)
{
    const struct kind *k = kind_of(unit), *other = NULL;
    const struct prefix *prefix;
    const struct symbol *symbol;
    char suggestion[NAME_SIZE];
    /* The right unit of another kind: say which. */
    for (int i = 0; i < UNIT_KINDS && !other; i++)
        if (unit_find(&KINDS[i], name, &prefix, &symbol)) other = &KINDS[i];
    if (unit == UNIT_NONE && other)
        snprintf(why, (size_t)size, "unexpected unit '%s'; expected %s such as '%s'", name, k->name,
                 k->example);
    else if (other)
        snprintf(why, (size_t)size, "'%s' is the unit of %s; expected %s such as '%s'", name,
                 other->name, k->name, k->example);
    /* Capital K: 1000 or 1024? Not guessed. */
    else if (name[0] == 'K' && name[1] != 'i' && unit_suggest(k, name, suggestion) &&
             suggestion[0] == 'k')
        snprintf(why, (size_t)size, "ambiguous unit '%s'; write '%s' for 1000 or 'Ki%s' for 1024",
                 name, suggestion, name + 1);
    else if (unit != UNIT_NONE && unit_suggest(k, name, suggestion))
        snprintf(why, (size_t)size, "unknown unit '%s'; did you mean '%s'?", name, suggestion);
    else
        snprintf(why, (size_t)size, "'%s' is not the unit of %s; expected for example '%s'", name,
                 k->name, k->example);
    return false;
}

/* has_digit: a digit other than zero, so the number is not meant to be zero. */
static bool has_digit(const char *s, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (s[i] >= '1' && s[i] <= '9') return true;
    return false;
}

bool units_parse(const char *text, enum unit unit, double *value, char *why, int size)
{
    const struct kind *k = kind_of(unit);
    const struct prefix *prefix = &PREFIXES[0];
    const struct symbol bare = {"", 0, 0, 0, 0}, *symbol = &bare;
    char name[64];
    size_t mantissa;
    while (isspace((unsigned char)*text)) text++;
    size_t span = number_span(text, &mantissa);
    if (span == 0 || mantissa > NUMBER_MAX) {
        snprintf(why, (size_t)size,
                 "'%.40s' does not start with a finite decimal number; expected %s such as '%s'",
                 text, k->name, k->example);
        return false;
    }
    unit_spelling(text + span, name, sizeof name);
    /* Units are never assumed. */
    if (unit != UNIT_NONE && name[0] == '\0') {
        snprintf(why, (size_t)size, "no unit; expected %s such as '%s'", k->name, k->example);
        return false;
    }
    if (name[0] != '\0' && !unit_find(k, name, &prefix, &symbol))
        return unit_wrong(unit, name, why, size);
    /* One rounding in scaled; ldexp is exact but at the ends of the range. */
    double x =
        ldexp(scaled(text, mantissa, span, prefix->e10 + symbol->e10), prefix->e2 + symbol->e2);
    if (symbol->rest != 0) x *= symbol->rest;
    /* Overflow, or a number that is not zero and became it. */
    if (!isfinite(x) || (x == 0 && has_digit(text, mantissa))) {
        snprintf(why, (size_t)size, "'%.40s' is too %s for a double", text,
                 x == 0 ? "small" : "large");
        return false;
    }
    *value = x;
    return true;
}

/* --- writing ---------------------------------------------------------------------------------- */

/* whole_digits: those of a whole number below 2^53, without the zeros at its end. No shorter number
 * reads back to it: another one of as many digits is at least 1 away, and half the distance of two
 * doubles is less. */
static int whole_digits(double x, char digits[20], int *exponent)
{
    int n = (int)(text_put_integer(digits, (int64_t)x) - digits);
    *exponent = n - 1;
    while (digits[n - 1] == '0') n--;
    return n;
}

/* fraction_digits: those of m where x = m / 10^k with the least k; 0: not found. Both m < 10^15 and
 * 10^k are doubles, so that one division gives what reading the decimal number gives (Clinger, PLDI
 * 1990); and of numbers with up to 15 digits at most one reads back to x, since doubles lie
 * closer. */
static int fraction_digits(double x, char digits[20], int *exponent)
{
    for (int k = 1; k <= EXACT_POWERS && x * power[k] < 1e15; k++) {
        const double m = trunc(x * power[k] + 0.5);
        if (m / power[k] != x) continue;
        const int n = whole_digits(m, digits, exponent);
        *exponent -= k;
        return n;
    }
    return 0;
}

/* shortest_digits: the fewest decimal digits (without point) and the exponent of the first that
 * read back to x > 0. Most settings are whole numbers; others are tried from one digit on, and 17
 * always suffice. */
static int shortest_digits(double x, char digits[20], int *exponent)
{
    char s[40];
    int n = 0;
    if (x < 0x1p53 && x == trunc(x)) return whole_digits(x, digits, exponent);
    if ((n = fraction_digits(x, digits, exponent)) > 0) return n;
    do snprintf(s, sizeof s, "%.*e", n++, x);
    while (n < 17 && strtod(s, NULL) != x);
    digits[0] = s[0];
    memcpy(digits + 1, s + 2, (size_t)(n - 1));
    *exponent = (int)strtol(strchr(s, 'e') + 1, NULL, 10);
    return n;
}

/* decimal: (n) digits, the first of which stands for 10^exponent, in plain notation where that is
 * short. */
static void decimal(const char *digits, int n, int exponent, char *buffer, size_t size)
{
    /* Most numbers of a configuration: a few digits, maybe with zeros behind. */
    if (exponent >= n - 1 && exponent < 16) {
        memcpy(buffer, digits, (size_t)n);
        memset(buffer + n, '0', (size_t)(exponent + 1 - n));
        buffer[exponent + 1] = '\0';
        return;
    }
    /* Plain notation only where it does not need long rows of zeros. */
    if (exponent < -5 || exponent > 16)
        snprintf(buffer, size, "%c%s%.*se%d", digits[0], n > 1 ? "." : "", n - 1, digits + 1,
                 exponent);
    else if (exponent < 0)
        snprintf(buffer, size, "0.%.*s%.*s", -exponent - 1, "0000000000", n, digits);
    else if (exponent >= n - 1)
        snprintf(buffer, size, "%.*s%.*s", n, digits, exponent - n + 1, "00000000000000000000");
    else
        snprintf(buffer, size, "%.*s.%.*s", exponent + 1, digits, n - exponent - 1,
                 digits + exponent + 1);
}

/* print_exponent: the power of 1000 of the prefix that leaves one to three digits before the point,
 * within the kind; x begins with 10^exponent. */
static int print_exponent(const struct kind *k, double x, int exponent)
{
    /* Kinds without a choice of prefixes; percent has a fixed one. */
    if (x == 0 || !isfinite(x) || k->print_min == k->print_max)
        return k->print_max < 0 ? k->print_min : 0;
    int thousands = (exponent >= 0 ? exponent : exponent - 2) / 3 * 3;
    if (thousands < k->print_min) return k->print_min;
    return thousands > k->print_max ? k->print_max : thousands;
}

/* "" where no prefix has these exponents: the number then stands without. */
static const char *prefix_name(int e10, int e2)
{
    for (const struct prefix *p = PREFIXES; p < PREFIXES + NPREFIX; p++)
        if (p->e10 == e10 && p->e2 == e2) return p->name;
    return "";
}

/* Sizes by powers of 1024 where they are whole, everything else by powers of 1000. */
void units_print(double value, enum unit unit, char *buffer, int size)
{
    const struct kind *k = kind_of(unit);
    double x = fabs(value);
    char number[64], digits[20];
    int e2 = 0, e10 = 0, n = 0, exponent = 0;
    if (unit == UNIT_BYTES) /* sizes that are whole Ki, Mi, ... are meant so */
        while (e2 < 40 && x > 0 && x < 0x1p53 && fmod(x, 1024) == 0) {
            x /= 1024;
            e2 += 10;
        }
    if (isfinite(x) && x != 0) n = shortest_digits(x, digits, &exponent);
    if (e2 == 0) e10 = print_exponent(k, x, exponent);
    /* Not numbers that can be read; they appear in messages only. */
    if (!isfinite(x)) text_copy(number, sizeof number, isnan(x) ? "nan" : "inf");
    else if (x == 0) text_copy(number, sizeof number, "0");
    else decimal(digits, n, exponent - e10, number, sizeof number);
    /* The first symbol of the kind: the one that is printed. */
    const char *name = k->symbol[0].name ? k->symbol[0].name : "";
    const char *const piece[] = {signbit(value) && !isnan(value) ? "-" : "", number,
                                 name[0] ? " " : "",
                                 unit == UNIT_PERCENT ? "" : prefix_name(e10, e2), name};
    size_t at = 0;
    for (size_t i = 0; i < sizeof piece / sizeof *piece; i++)
        text_copy(buffer + at, (size_t)size - at, piece[i]), at += strlen(buffer + at);
}
