// The failed ones of the services that merlind can do without: its configuration's file, the state's file, shared memory.

const readable = name => name[0].toUpperCase() + name.slice(1);

// A sentence for each service that has failed, of the roles of /api/status that run. Both roles of one process report the
// same failures: each sentence is in the list once.
export function failedServices(roles) {
  const sentences = Object.values(roles).filter(role => role.running && role.status).flatMap(role =>
      Object.entries(role.status.services || {}).filter(([, service]) => service.health !== "ok")
          .map(([name, service]) => `${readable(name)} failed: ${service.reason}`));
  return [...new Set(sentences)];
}
