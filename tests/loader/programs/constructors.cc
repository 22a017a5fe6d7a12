/* constructors.cc - objects made before main and destroyed behind it, thread-locals, standard
 * streams. */
#include <iostream>
#include <string>
#include <vector>
#include <unistd.h>
#include <mimdsim/host.h>
struct logger {
    const char *name;
    logger(const char *n) : name(n) { std::cout << "+" << n << std::endl; }
    ~logger() { std::cout << "-" << name << std::endl; }
};
static logger global("global");
thread_local logger local("local");
static std::vector<std::string> words = {"one", "a longer word than fits inside"};
int main()
{
    local.name = "used";
    words.push_back("x");
    usleep(1);
    static logger in_function("function");
    std::cout << words.size() << ' ' << words[1] << ' ' << 1.5 << std::endl;
    return 0;
}
