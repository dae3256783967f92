/* A Modbus device as quick as they come: libmodbus, one client at a time.

   libmodbus_server tcp PORT | libmodbus_server rtu PATH BAUD; says "ready" once it
   listens. What it holds at first is told in contents.py. */

#include <modbus.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BITS 2000
#define REGISTERS 5000
#define UNIT 1

static modbus_mapping_t *filled(void)
{
    modbus_mapping_t *all = modbus_mapping_new(BITS, BITS, REGISTERS, REGISTERS);
    int i;

    if (all == NULL)
        exit(1);
    for (i = 0; i < BITS; i++) {
        all->tab_bits[i] = i % 3 == 0;
        all->tab_input_bits[i] = i % 5 == 0;
    }
    for (i = 0; i < REGISTERS; i++) {
        all->tab_registers[i] = 1000 + i;
        all->tab_input_registers[i] = 8000 + i;
    }
    return all;
}

static void serve(modbus_t *context, modbus_mapping_t *contents)
{
    uint8_t request[MODBUS_TCP_MAX_ADU_LENGTH];

    for (;;) {
        int length = modbus_receive(context, request);
        if (length == -1)
            return;
        if (length > 0 && modbus_reply(context, request, length, contents) == -1)
            return;
    }
}

static int ready(void)
{
    puts("ready");
    return fflush(stdout);
}

static int serial(const char *path, int baud)
{
    modbus_mapping_t *contents = filled();
    modbus_t *context = modbus_new_rtu(path, baud, 'N', 8, 1);

    if (modbus_set_slave(context, UNIT) == -1 || modbus_connect(context) == -1)
        return 1;
    for (ready();;)
        serve(context, contents);
}

static int tcp(int port)
{
    modbus_mapping_t *contents = filled();
    modbus_t *context = modbus_new_tcp("127.0.0.1", port);
    int listener = modbus_tcp_listen(context, 1);

    if (listener == -1)
        return 1;
    ready();
    while (modbus_tcp_accept(context, &listener) != -1) {
        serve(context, contents);
        modbus_close(context);
    }
    return 1;
}

int main(int count, char **words)
{
    if (count == 3 && strcmp(words[1], "tcp") == 0)
        return tcp(atoi(words[2]));
    if (count == 4 && strcmp(words[1], "rtu") == 0)
        return serial(words[2], atoi(words[3]));
    return 2;
}
