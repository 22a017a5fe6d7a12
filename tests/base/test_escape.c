/* test_escape.c - one list of texts of strangers, and what becomes of each at the terminal and in
 * Markdown. */
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/escape.h"
#include "base/text.h"

/* What is shown; NULL: the text itself. */
static const struct {
    const char *text, *terminal, *markdown;
} list[] = {
    {"plain words, 1.5 us/hop (P = 16)", NULL, NULL},
    {"Größe, 速度, naïve", NULL, NULL},
    {"\033[31mred\033[0m", "\\u001b[31mred\\u001b[0m", "\\\\u001b\\[31mred\\\\u001b\\[0m"},
    {"\033]52;c;Z28=\007", "\\u001b]52;c;Z28=\\u0007", "\\\\u001b\\]52;c;Z28=\\\\u0007"},
    {"a\rb", "a\\u000db", "a b"},
    {"a\r\nb", "a\r\nb", "a  b"},
    {"back\b\b\x7f", "back\\u0008\\u0008\\u007f", "back\\\\u0008\\\\u0008\\\\u007f"},
    {"\xc2\x9b"
     "31m",
     "\\u009b31m", NULL},
    {"\x9b"
     "31m \xff\xc3",
     "\\u009b31m \\u00ff\\u00c3", NULL},
    {"\xe2\x80\xae"
     "txt.exe",
     "\\u202etxt.exe", NULL},
    {"<script>alert('x')</script>", NULL, "\\<script\\>alert('x')\\</script\\>"},
    {"\\<img onerror>", NULL, "\\\\\\<img onerror\\>"},
    {"\" onload=\"x", NULL, NULL},
    {"&lt;b&gt;", NULL, "\\&lt;b\\&gt;"},
    {"[a](javascript:b)", NULL, "\\[a\\](javascript:b)"},
    {"`code` *a* _b_ ~c~ |d| \\", NULL, "\\`code\\` \\*a\\* \\_b\\_ \\~c\\~ \\|d\\| \\\\"},
    {"# no heading", NULL, "\\# no heading"},
    {"- no item", NULL, "\\- no item"},
    {"12. no item", NULL, "12\\. no item"},
};
enum { LIST = sizeof list / sizeof *list };

static void expect(const char *sink, const char *text, const char *got, const char *wanted)
{
    if (strcmp(got, wanted ? wanted : text) != 0) fail_msg("%s of '%s': '%s'", sink, text, got);
}

static void markdown_shows_every_text_as_it_is(void **state)
{
    (void)state;
    for (int i = 0; i < LIST; i++) {
        struct text t = {0};
        FILE *out = text_stream(&t);
        escape_markdown(out, list[i].text, true);
        text_stream_end(out);
        expect("Markdown", list[i].text, t.s, list[i].markdown);
        text_free(&t);
    }
}

/* In a child, whose output is read. Piece by piece: a character may come in two writes. */
static void terminal(const char *text, size_t piece, int descriptor, bool raw, char *got,
                     size_t size)
{
    int ends[2], status = 0;
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], descriptor);
        escape_terminal();
        FILE *to = descriptor == 1 ? stdout : stderr;
        if (raw) escape_raw(descriptor, text, strlen(text));
        for (const char *s = text; !raw && *s; s += strnlen(s, piece)) {
            fprintf(to, "%.*s", (int)strnlen(s, piece), s);
            fflush(to);
        }
        fprintf(to, "\n");
        exit(0);
    }
    close(ends[1]);
    size_t n = 0;
    for (ssize_t k; n + 1 < size && (k = read(ends[0], got + n, size - 1 - n)) > 0;) n += (size_t)k;
    close(ends[0]);
    waitpid(child, &status, 0);
    got[n] = '\0';
    assert_true(n > 0 && got[n - 1] == '\n');
    got[n - 1] = '\0';
}

static void a_terminal_obeys_no_text(void **state)
{
    char got[256];
    (void)state;
    for (int i = 0; i < LIST; i++)
        for (size_t piece = 1; piece <= 64; piece *= 4) {
            terminal(list[i].text, piece, 1 + i % 2, false, got, sizeof got);
            expect("terminal", list[i].text, got, list[i].terminal);
        }
}

static void what_programs_of_the_user_print_goes_past_it(void **state)
{
    char got[256];
    (void)state;
    for (int i = 0; i < LIST; i++) {
        terminal(list[i].text, 64, 1 + i % 2, true, got, sizeof got);
        expect("raw", list[i].text, got, NULL);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(markdown_shows_every_text_as_it_is),
        cmocka_unit_test(a_terminal_obeys_no_text),
        cmocka_unit_test(what_programs_of_the_user_print_goes_past_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
