#!/usr/bin/python3
"""What labgrid's coordinator, exporter and client speak over: a WAMP router (labgrid names crossbar, which Debian has not).

    labgrid_router.py PORT

Just what they need: one realm, nobody is asked who he is, calls, events, and who joins and leaves. Needs python3-autobahn.
"""
import asyncio
import itertools
import sys

from autobahn.asyncio.websocket import WampWebSocketServerFactory
from autobahn.wamp import message, role

number = itertools.count(1)
sessions, procedures, topics, calls = {}, {}, {}, {}
ROLES = {"broker": role.RoleBrokerFeatures(session_meta_api=True, publisher_exclusion=True),
         "dealer": role.RoleDealerFeatures(caller_identification=True, session_meta_api=True)}


def publish(topic, args, kwargs=None, but=None):
    subscription, subscribers = topics.get(topic, (0, ()))
    for one in subscribers:
        if one is not but:
            one.send(message.Event(subscription, next(number), args=args, kwargs=kwargs))


class Session:
    _authid = _session_id = None

    def onOpen(self, transport):
        self.transport = transport

    def send(self, answer):
        if self.transport.isOpen():
            self.transport.send(answer)

    def onMessage(self, said):
        getattr(self, "on_" + type(said).__name__.lower())(said)

    def onClose(self, _):
        sessions.pop(self._session_id, None)
        for _, subscribers in topics.values():
            subscribers.discard(self)
        for name in [name for name, (_, callee) in procedures.items() if callee is self]:
            del procedures[name]
        publish("wamp.session.on_leave", [self._session_id])

    def on_hello(self, said):
        self._session_id, self._authid = next(number), said.authid or "nobody"
        sessions[self._session_id] = self
        self.send(message.Welcome(self._session_id, ROLES, realm=said.realm, authid=self._authid, authrole="public",
                                  authmethod="anonymous"))
        publish("wamp.session.on_join", [{"session": self._session_id, "authid": self._authid}])

    def on_goodbye(self, _):
        self.send(message.Goodbye("wamp.close.goodbye_and_out"))
        self.transport.sendClose()

    def on_subscribe(self, said):
        subscription, subscribers = topics.setdefault(said.topic, (next(number), set()))
        subscribers.add(self)
        self.send(message.Subscribed(said.request, subscription))

    def on_publish(self, said):
        publish(said.topic, said.args, said.kwargs, but=self)

    def on_register(self, said):
        procedures[said.procedure] = next(number), self
        self.send(message.Registered(said.request, procedures[said.procedure][0]))

    def on_call(self, said):
        if said.procedure not in procedures:
            return self.send(message.Error(message.Call.MESSAGE_TYPE, said.request, "wamp.error.no_such_procedure"))
        registration, callee = procedures[said.procedure]
        calls[request := next(number)] = self, said.request
        callee.send(message.Invocation(request, registration, args=said.args, kwargs=said.kwargs, caller=self._session_id,
                                       caller_authid=self._authid, caller_authrole="public"))

    def on_yield(self, said):
        caller, request = calls.pop(said.request)
        caller.send(message.Result(request, args=said.args, kwargs=said.kwargs))

    def on_error(self, said):
        caller, request = calls.pop(said.request)
        caller.send(message.Error(message.Call.MESSAGE_TYPE, request, said.error, args=said.args, kwargs=said.kwargs))


def main(port):
    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    loop.run_until_complete(loop.create_server(WampWebSocketServerFactory(Session, loop=loop), "127.0.0.1", port))
    print("listens", flush=True)
    loop.run_forever()


main(int(sys.argv[1]))
