/* expression.c - a parser by recursive descent into a tree, and a walk over it; see expression.h.
 *
 * The grammar, loosest first: or, and, not, one comparison, sums, products, signs. A comparison
 * gives besides its truth by how much it is missed, so that a search knows which of two wrong
 * points is the better one. */
#include "base/expression.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/text.h"

enum operation { NUMBER, WORD, QUOTED, OR, AND, NOT, COMPARE, SUM, PRODUCT, MINUS, FUNCTION };

struct expression {
    enum operation operation;
    const char
        *text; /* of the root: as written; of names and texts: themselves; else the operator */
    struct expression_value value; /* NUMBER */
    struct expression *left, *right;
};

/* The text being read: from where it stands, and the first mistake. */
struct parser {
    const char *start, *at;
    struct arena *arena;
    char *why;
    int size, depth;
    bool failed;
};

/* The first mistake is told, with the rest of the text behind it. Always NULL. */
static struct expression *mistake(struct parser *p, const char *what)
{
    if (!p->failed) {
        if (*p->at == '\0') snprintf(p->why, (size_t)p->size, "%s at its end", what);
        else snprintf(p->why, (size_t)p->size, "%s before '%.40s'", what, p->at);
    }
    p->failed = true;
    return NULL;
}

/* Blanks separate words and mean nothing else. */
static void skip_blanks(struct parser *p)
{
    while (isspace((unsigned char)*p->at)) p->at++;
}

static bool is_word_byte(char c) { return isalnum((unsigned char)c) || c == '_' || c == '.'; }

/* The length of the word here, 0: none. A hyphen belongs to it between letters or digits. */
static size_t word_length(const char *s)
{
    size_t n = 0;
    if (!isalpha((unsigned char)*s) && *s != '_') return 0;
    while (is_word_byte(s[n]) || (s[n] == '-' && isalnum((unsigned char)s[n + 1]))) n++;
    return n;
}

/* Whether `word` stands here, as a whole word or as a sign; it is taken. */
static bool take(struct parser *p, const char *word)
{
    skip_blanks(p);
    const size_t n = strlen(word);
    if (strncmp(p->at, word, n) != 0) return false;
    if (isalpha((unsigned char)*word) && word_length(p->at) != n) return false;
    p->at += n;
    return true;
}

/* One operation or value; its children are made before it. */
static struct expression *node(struct parser *p, enum operation operation, const char *text,
                               struct expression *left, struct expression *right)
{
    struct expression *x = TAKE(p->arena, 1, struct expression);
    *x = (struct expression){.operation = operation, .text = text, .left = left, .right = right};
    return x;
}

/* A part of the text as a text of its own, in the arena of the tree. */
static const char *copy(struct parser *p, const char *s, size_t n)
{
    char *text = TAKE(p->arena, n + 1, char);
    memcpy(text, s, n);
    text[n] = '\0';
    return text;
}

/* Whether `text`, a number and a unit, is a quantity of some kind. */
static bool read_quantity(const char *text, struct expression_value *v)
{
    char why[200];
    for (int u = UNIT_NONE + 1; u < UNIT_KINDS; u++)
        if (units_parse(text, (enum unit)u, &v->number, why, (int)sizeof why)) {
            v->unit = (enum unit)u;
            return true;
        }
    return false;
}

/* A number and the unit behind it. `2%` is a share, `2 % 3` a remainder: a percent sign is a unit
 * only where it touches the number. Of "GB/s" the longest part that is a unit counts. */
static struct expression *read_number(struct parser *p)
{
    char *end;
    struct expression *x = node(p, NUMBER, NULL, NULL, NULL);
    x->value.number = strtod(p->at, &end);
    if (!isfinite(x->value.number)) return mistake(p, "a number that is too large");
    const char *unit = end;
    if (*unit == '%') {
        p->at = unit + 1;
        x->value.number /= 100;
        x->value.unit = UNIT_PERCENT;
        return x;
    }
    while (*unit == ' ') unit++;
    /* both candidates: the letters, and the letters with what is divided by */
    size_t first = 0, whole;
    while (isalpha((unsigned char)unit[first])) first++;
    whole = first;
    if (first > 0 && unit[first] == '/')
        for (whole++; isalpha((unsigned char)unit[whole]);) whole++;
    /* the longer one first: "B/s" is not a number of bytes, divided by s */
    const size_t length[] = {whole, first};
    for (int i = 0; i < 2 && first > 0; i++) {
        const char *text = copy(p, p->at, (size_t)(unit - p->at) + length[i]);
        if (read_quantity(text, &x->value)) return p->at = unit + length[i], x;
    }
    p->at = end;
    if (is_word_byte(*end)) return mistake(p, "an unknown unit");
    return x;
}

static struct expression *read_or(struct parser *p);

/* f(a) or f(a, b); the bracket has been seen. */
static struct expression *read_function(struct parser *p, const char *name)
{
    /* what each takes is known here, so that a wrong number of arguments is told at once */
    const bool two = strcmp(name, "min") == 0 || strcmp(name, "max") == 0;
    if (!two && strcmp(name, "log2") != 0 && strcmp(name, "sqrt") != 0)
        return mistake(p, "a function that is none of log2, sqrt, min, max");
    /* each argument is a whole expression: the comma binds loosest of all */
    struct expression *left = read_or(p), *right = NULL;
    if (left == NULL) return NULL;
    if (two) {
        if (!take(p, ",")) return mistake(p, "a comma is missing");
        right = read_or(p);
        if (right == NULL) return NULL;
    }
    return take(p, ")") ? node(p, FUNCTION, name, left, right) : mistake(p, "')' is missing");
}

/* A text in quotes of either kind; the first has been seen. */
static struct expression *read_quoted(struct parser *p)
{
    /* a text ends at the quote that it began with */
    const char quote = *p->at++, *end = strchr(p->at, quote);
    if (end == NULL) return mistake(p, "the quote that ends a text is missing");
    const char *text = copy(p, p->at, (size_t)(end - p->at));
    p->at = end + 1;
    return node(p, QUOTED, text, NULL, NULL);
}

/* What binds closest: brackets, numbers, texts, names and functions. */
static struct expression *read_primary(struct parser *p)
{
    skip_blanks(p);
    if (take(p, "(")) {
        struct expression *x = read_or(p);
        if (x == NULL) return NULL;
        return take(p, ")") ? x : mistake(p, "')' is missing");
    }
    if (isdigit((unsigned char)*p->at) || *p->at == '.') return read_number(p);
    if (*p->at == '\'' || *p->at == '"') return read_quoted(p);
    const size_t n = word_length(p->at);
    if (n == 0) return mistake(p, "expected a number or a name");
    const char *word = copy(p, p->at, n);
    p->at += n;
    return take(p, "(") ? read_function(p, word) : node(p, WORD, word, NULL, NULL);
}

/* Every level of brackets and signs passes here: the depth is counted once. */
static struct expression *read_sign(struct parser *p)
{
    if (++p->depth > EXPRESSION_MAX_DEPTH) return mistake(p, "too many brackets or signs");
    struct expression *x;
    if (take(p, "-")) {
        x = read_sign(p);
        if (x != NULL) x = node(p, MINUS, "-", x, NULL);
    } else x = read_primary(p);
    p->depth--;
    return x;
}

/* left to right: "a - b - c" is (a - b) - c */
static struct expression *read_chain(struct parser *p, enum operation operation,
                                     const char *const *sign,
                                     struct expression *(*part)(struct parser *))
{
    struct expression *x = part(p);
    /* one operator a turn, and the tree grows to the left;
     * after each operator all of them are tried again */
    for (int i = 0; x != NULL && sign[i] != NULL;) {
        if (!take(p, sign[i])) {
            i++;
            continue;
        }
        struct expression *right = part(p);
        x = right == NULL ? NULL : node(p, operation, sign[i], x, right);
        i = 0;
    }
    return x;
}

/* The levels of the grammar, each by the one that binds closer. */
static struct expression *read_product(struct parser *p)
{
    static const char *const sign[] = {"*", "/", "%", NULL};
    return read_chain(p, PRODUCT, sign, read_sign);
}

static struct expression *read_sum(struct parser *p)
{
    static const char *const sign[] = {"+", "-", NULL};
    return read_chain(p, SUM, sign, read_product);
}

/* One comparison: "a < b < c" means something else to everybody, so it is refused. */
static struct expression *read_comparison(struct parser *p)
{
    static const char *const sign[] = {"<=", ">=", "==", "!=", "<", ">", NULL};
    struct expression *x = read_sum(p);
    for (int i = 0; x != NULL && sign[i] != NULL; i++) {
        if (!take(p, sign[i])) continue;
        struct expression *right = read_sum(p);
        if (right == NULL) return NULL;
        x = node(p, COMPARE, sign[i], x, right);
        for (int k = 0; sign[k] != NULL; k++)
            if (take(p, sign[k]))
                return mistake(p, "a second comparison: write 'a < b and b < c',");
        return x;
    }
    return x;
}

/* The recursion of `not` is counted, too. */
static struct expression *read_not(struct parser *p)
{
    if (!take(p, "not")) return read_comparison(p);
    if (++p->depth > EXPRESSION_MAX_DEPTH) return mistake(p, "too many brackets or signs");
    struct expression *x = read_not(p);
    p->depth--;
    return x == NULL ? NULL : node(p, NOT, "not", x, NULL);
}

/* `and` binds closer than `or`, as everywhere. */
static struct expression *read_and(struct parser *p)
{
    static const char *const sign[] = {"and", NULL};
    return read_chain(p, AND, sign, read_not);
}

static struct expression *read_or(struct parser *p)
{
    static const char *const sign[] = {"or", NULL};
    return read_chain(p, OR, sign, read_and);
}

struct expression *expression_read(const char *text, struct arena *a, char *why, int size)
{
    struct parser p = {.start = text, .at = text, .arena = a, .why = why, .size = size};
    /* A length first: what is parsed afterwards has at most as many nodes. */
    if (strlen(text) > EXPRESSION_MAX_LENGTH) {
        snprintf(why, (size_t)size, "longer than %d characters", EXPRESSION_MAX_LENGTH);
        return NULL;
    }
    struct expression *x = read_or(&p);
    skip_blanks(&p);
    if (x != NULL && *p.at == '=') return mistake(&p, "a single '=' where '==' was meant,");
    if (x != NULL && *p.at != '\0') return mistake(&p, "expected an operator");
    if (x == NULL) return NULL;
    /* The root alone knows the whole text; names and texts keep theirs one node below. */
    struct expression *root = node(&p, OR, arena_text(a, text), x, NULL);
    return root;
}

/* The root's own text. */
const char *expression_text(const struct expression *x) { return x->text; }

/* ---- values */

/* What every step of an evaluation needs. */
struct walk {
    expression_lookup_fn *lookup;
    void *context;
    char *why;
    int size;
};

__attribute__((format(printf, 2, 3))) static bool wrong(struct walk *w, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    vsnprintf(w->why, (size_t)w->size, format, list);
    va_end(list);
    return false;
}

static bool value_of(struct walk *w, const struct expression *x, struct expression_value *v);

/* Whether two numbers may be compared or added. */
static bool units_fit(struct walk *w, const char *sign, const struct expression_value *a,
                      const struct expression_value *b)
{
    if (a->unit == b->unit || a->unit == UNIT_KINDS || b->unit == UNIT_KINDS) return true;
    return wrong(w, "%s on the left of '%s', %s on the right", units_name(a->unit), sign,
                 units_name(b->unit));
}

/* What a condition gives: whether it holds, and else by how much it is missed. */
static struct expression_value truth(bool holds, double excess)
{
    return (struct expression_value){.number = holds, .truth = true, .excess = holds ? 0 : excess};
}

/* A word that nobody knows stands for itself beside a text. */
static bool side(struct walk *w, const struct expression *x, const struct expression *other,
                 struct expression_value *v)
{
    char ignored[16];
    struct expression_value beside;
    *v = (struct expression_value){0};
    if (x->operation == WORD && !w->lookup(w->context, x->text, v, ignored, (int)sizeof ignored)) {
        const bool text =
            other->operation == WORD &&
            w->lookup(w->context, other->text, &beside, ignored, (int)sizeof ignored) &&
            beside.text != NULL;
        if (text || other->operation == QUOTED) return v->text = x->text, true;
    }
    return value_of(w, x, v);
}

/* NaN is not known: no comparison with it holds, and no point is further from holding. */
static bool compare(struct walk *w, const struct expression *x, struct expression_value *v)
{
    struct expression_value a, b;
    if (!side(w, x->left, x->right, &a) || !side(w, x->right, x->left, &b)) return false;
    const char *s = x->text;
    const bool equality = s[1] == '=' && (s[0] == '=' || s[0] == '!');
    if ((a.text != NULL) != (b.text != NULL))
        return wrong(w, "'%s' compares a text with a number", s);
    if (a.text != NULL) {
        if (!equality) return wrong(w, "'%s' compares texts; only == and != can", s);
        return *v = truth((strcmp(a.text, b.text) == 0) == (s[0] == '='), 1), true;
    }
    if (!units_fit(w, s, &a, &b)) return false;
    if (isnan(a.number) || isnan(b.number)) return *v = truth(false, 1e6), true;
    /* relative, so that conditions on times and on counts add up */
    const double scale = fmax(fabs(a.number), fabs(b.number)),
                 gap = scale > 0 ? fabs(a.number - b.number) / scale : 0;
    bool holds;
    /* the first byte of the sign is the direction, a second '=' includes equality */
    if (equality) holds = (a.number == b.number) == (s[0] == '=');
    else if (s[1] == '=') holds = s[0] == '<' ? a.number <= b.number : a.number >= b.number;
    else holds = s[0] == '<' ? a.number < b.number : a.number > b.number;
    /* a gap of none that does not hold is that of "<" at the border */
    *v = truth(holds, fmax(gap, 1e-9));
    return true;
}

/* Both operands, which have to be numbers; the second is 0 where there is none. */
static bool numbers(struct walk *w, const struct expression *x, struct expression_value *a,
                    struct expression_value *b)
{
    *b = (struct expression_value){0};
    if (!value_of(w, x->left, a) || (x->right != NULL && !value_of(w, x->right, b))) return false;
    if (a->text == NULL && b->text == NULL) return true;
    return wrong(w, "'%s' takes numbers, not the text '%.40s'", x->text,
                 a->text != NULL ? a->text : b->text);
}

/* The kind of a product or quotient, where it has a name. */
static enum unit unit_of(char sign, enum unit a, enum unit b)
{
    if (b == UNIT_NONE || b == UNIT_PERCENT) return a;
    if (sign == '*') return a == UNIT_NONE || a == UNIT_PERCENT ? b : UNIT_KINDS;
    return a == b && a != UNIT_KINDS ? UNIT_NONE : UNIT_KINDS;
}

/* Division by zero is not known (NaN), as it depends on the point and is no mistake of the text. */
static bool product(struct walk *w, const struct expression *x, struct expression_value *v)
{
    struct expression_value a, b;
    if (!numbers(w, x, &a, &b)) return false;
    const char sign = x->text[0];
    *v = (struct expression_value){.unit = unit_of(sign, a.unit, b.unit)};
    if (sign == '*') v->number = a.number * b.number;
    else if (b.number == 0) v->number = NAN;
    else v->number = sign == '/' ? a.number / b.number : fmod(a.number, b.number);
    /* a remainder is of the kind of what it remains of */
    if (sign == '%') v->unit = a.unit;
    return true;
}

/* log2 and sqrt of what they are not defined for are not known, either. */
static bool function(struct walk *w, const struct expression *x, struct expression_value *v)
{
    struct expression_value a, b;
    if (!numbers(w, x, &a, &b)) return false;
    *v = (struct expression_value){.unit = UNIT_KINDS};
    if (strcmp(x->text, "log2") == 0)
        v->number = a.number > 0 ? log2(a.number) : NAN, v->unit = UNIT_NONE;
    else if (strcmp(x->text, "sqrt") == 0) v->number = a.number >= 0 ? sqrt(a.number) : NAN;
    else {
        if (!units_fit(w, x->text, &a, &b)) return false;
        v->unit = a.unit;
        v->number = x->text[1] == 'i' ? fmin(a.number, b.number) : fmax(a.number, b.number);
    }
    return true;
}

/* Of conditions: what is missed by `and` adds up, of `or` the nearer one counts. */
static bool logic(struct walk *w, const struct expression *x, struct expression_value *v)
{
    struct expression_value a, b;
    if (!numbers(w, x, &a, &b)) return false;
    /* a plain number may stand for a condition inside: 0 is false */
    const bool left = a.number != 0, right = b.number != 0;
    const double missed_left = left ? 0 : fmax(a.excess, 1e-9),
                 missed_right = right ? 0 : fmax(b.excess, 1e-9);
    if (x->operation == NOT) *v = truth(!left, 1);
    else if (x->operation == AND) *v = truth(left && right, missed_left + missed_right);
    else *v = truth(left || right, fmin(missed_left, missed_right));
    return true;
}

/* Recursion is as deep as the text has operators: its length is limited. */
static bool value_of(struct walk *w, const struct expression *x, struct expression_value *v)
{
    struct expression_value b;
    *v = (struct expression_value){0};
    switch (x->operation) {
    case NUMBER:
        return *v = x->value, true;
    case QUOTED:
        return v->text = x->text, true;
    case WORD:
        return w->lookup(w->context, x->text, v, w->why, w->size);
    case COMPARE:
        return compare(w, x, v);
    case OR:
    case AND:
    case NOT:
        return logic(w, x, v);
    case PRODUCT:
        return product(w, x, v);
    case FUNCTION:
        return function(w, x, v);
    case MINUS:
        if (!numbers(w, x, v, &b)) return false;
        return v->number = -v->number, true;
    case SUM:
        if (!numbers(w, x, v, &b) || !units_fit(w, x->text, v, &b)) return false;
        v->number += x->text[0] == '+' ? b.number : -b.number;
        return true;
    }
    return false;
}

/* The root is a frame around the formula that knows its text. */
bool expression_value(const struct expression *x, expression_lookup_fn *lookup, void *context,
                      struct expression_value *v, char *why, int size)
{
    struct walk w = {lookup, context, why, size};
    return value_of(&w, x->left, v);
}
